// SPDX-License-Identifier: Apache-2.0
// The server behind proxies that were told nothing but where it is, and behind two of them.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { startServer } from '../support/server.mjs';
import { kSite, startDocumentedNginx, startDocumentedVarnish, startNginx } from '../support/proxies.mjs';
import { Client } from './client.mjs';

const kScene = { objects: [{ type: 'sphere' }], image: { width: 8, height: 8 }, render: { samples: 1 } };
const kPng = { Accept: 'image/png' };

const startPlainNginx = (server) => startNginx(({ port }) => `server {
  listen 127.0.0.1:${port};
  location / { proxy_pass http://127.0.0.1:${server.port}; }
  location /render/ { proxy_pass http://127.0.0.1:${server.port}/; }
  location /host/ { proxy_pass http://127.0.0.1:${server.port}/; proxy_set_header Host $host; }
  location /port/ { proxy_pass http://127.0.0.1:${server.port}/; proxy_set_header Host $host:$server_port; }
}`);

let server;
let nginx;
before(async () => {
  server = await startServer();
  nginx = await startPlainNginx(server);
});
after(async () => {
  await nginx?.stop();
  await server?.stop();
});

test('behind proxy_pass alone a browser may render: it says itself that the page is of the same site', async (t) => {
  const client = new Client({ port: nginx.port, say: (line) => t.diagnostic(`nginx ${line}`) });
  for (const path of ['/v1/renders', '/render/v1/renders', '/host/v1/renders', '/port/v1/renders']) {
    const statusWith = async (headers) => (await client.ask('POST', path, { headers: { ...kPng, ...headers }, body: kScene })).status;
    const origin = 'https://127.0.0.1:8443';
    assert.equal(await statusWith({ Origin: origin, 'Sec-Fetch-Site': 'same-origin' }), 200);
    assert.equal(await statusWith({ Origin: origin, 'Sec-Fetch-Site': 'cross-site' }), 403);
    assert.equal(await statusWith({ Origin: origin, 'Sec-Fetch-Site': 'same-site' }), 403);
    assert.equal(await statusWith({ Origin: origin }), 403, 'an older browser needs the line about Host');
  }
});

// The client is none of the proxies that the server or, in the file, Varnish trusts.
for (const { name, flags, startProxy } of [
  { name: 'a proxy that is not trusted', flags: [], startProxy: startPlainNginx },
  { name: 'Varnish of docker/proxies', flags: ['--trusted-proxy', '127.0.0.1'], startProxy: startDocumentedVarnish },
]) {
  test(`what a client says of itself through ${name} counts for nothing`, async () => {
    const behind = await startServer(flags);
    const proxy = await startProxy(behind);
    try {
      const client = new Client({ port: proxy.port, from: '127.0.0.2' });
      const accepted = await client.ask('POST', '/v1/renders', {
        headers: { 'X-Forwarded-Prefix': '/elsewhere', 'X-Forwarded-For': '192.0.2.1', 'X-Forwarded-Host': 'evil.example', 'X-Forwarded-Proto': 'https' },
        body: kScene,
      });
      assert.equal(accepted.status, 202);
      assert.match(accepted.headers.location, /^\/v1\/renders\//);
      const id = accepted.headers.location.split('/').pop();
      assert.ok((await client.json('GET', '/v1/renders')).renders.some((it) => it.id === id));
    } finally {
      await proxy.stop();
      await behind.stop();
    }
  });
}

test('through two proxies the client and its site are those that the outer one saw', async (t) => {
  const behind = await startServer(['--allowed-hosts', kSite, '--trusted-proxy', '127.0.0.1,127.0.0.9']);
  // The inner one adds to what it gets and comes to the server by another address.
  const inner = await startNginx(({ port }) => `server {
    listen 127.0.0.1:${port};
    location / {
      proxy_pass http://127.0.0.1:${behind.port};
      proxy_bind 127.0.0.9;
      proxy_set_header X-Forwarded-For $proxy_add_x_forwarded_for;
    }
  }`);
  const outer = await startDocumentedNginx(inner);
  try {
    const client = (from) => new Client({ port: outer.port, host: kSite, from, say: (line) => t.diagnostic(`nginx, nginx ${line}`) });
    const [one, two] = [client('127.0.0.2'), client('127.0.0.3')];
    const accepted = await one.ask('POST', '/render/v1/renders', { headers: { Origin: one.origin }, body: kScene });
    assert.equal(accepted.status, 202);
    assert.match(accepted.headers.location, /^\/render\/v1\/renders\//);
    const listOf = async (who, headers) => (await who.json('GET', '/v1/renders', { headers })).renders.length;
    assert.equal(await listOf(one), 1);
    assert.equal(await listOf(two), 0);
    assert.equal(await listOf(two, { 'X-Forwarded-For': '127.0.0.2, 127.0.0.1' }), 0);
  } finally {
    await outer.stop();
    await inner.stop();
    await behind.stop();
  }
});
