// SPDX-License-Identifier: Apache-2.0
// The page's files, renders, events and sessions through nginx and HAProxy as docker/proxies sets them up, with TLS.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { startServer } from '../support/server.mjs';
import { kSite, startDocumentedHaproxy, startDocumentedNginx } from '../support/proxies.mjs';
import { Client, metric, statusByHttp2 } from './client.mjs';

const kScene = { objects: [{ type: 'sphere' }], image: { width: 8, height: 8 }, render: { samples: 1 } };
const kEndless = { objects: [{ type: 'chess_position', detail: 48 }], image: { width: 1000, height: 1000 }, render: { samples: 4096, seed: 77 } };
const kPng = { Accept: 'image/png' };
const kWaitS = 1;  // the server's longest, in place of 40
const kProxyS = 10;  // the proxy's patience, in place of 50 and 60

for (const [name, startProxy] of [['nginx', startDocumentedNginx], ['HAProxy', startDocumentedHaproxy]]) {
  describe(`behind ${name}`, () => {
    let server;
    let proxy;
    before(async () => {
      server = await startServer(['--allowed-hosts', kSite, '--trusted-proxy', '127.0.0.1', '--max-wait-s', String(kWaitS)]);
      proxy = await startProxy(server, kProxyS);
    });
    after(async () => {
      await proxy?.stop();
      await server?.stop();
    });
    const clientOf = (t, from = '127.0.0.2') => new Client({
      port: proxy.port, host: kSite, from, say: (line) => t.diagnostic(`${name} ${line}`),
    });

    test('the files of the page come, at the root and under a path', async (t) => {
      const client = clientOf(t);
      for (const base of ['/', '/render/']) {
        const page = await client.ask('GET', base);
        assert.equal(page.status, 200);
        assert.match(page.headers['content-security-policy'], /default-src 'none'/);
        const linked = [...page.body.toString().matchAll(/(?:href|src)="([^"#]+)"/g)].map((match) => match[1]);
        assert.ok(linked.length >= 4);
        for (const file of linked) {
          const { pathname } = new URL(file, `https://x${base}`);
          assert.ok(pathname.startsWith(base), `${file} stays under ${base}`);
          assert.equal((await client.ask('GET', pathname)).status, 200, pathname);
        }
      }
      const bare = await client.ask('GET', '/render');
      assert.equal(bare.status, 301);
      assert.match(bare.headers.location, /\/render\/$/);
    });

    test('a page of the site may render, however the browser tells its origin, and other pages may not', async (t) => {
      const client = clientOf(t);
      const statusWith = async (headers) => (await client.ask('POST', '/v1/renders', { headers: { ...kPng, ...headers }, body: kScene })).status;
      assert.equal(await statusWith({ Origin: client.origin, 'Sec-Fetch-Site': 'same-origin' }), 200);
      assert.equal(await statusWith({ Origin: client.origin }), 200, 'a browser before Sec-Fetch-Site');
      assert.equal(await statusWith({}), 200, 'no browser');
      assert.equal(await statusWith({ Origin: 'https://evil.example', 'Sec-Fetch-Site': 'cross-site' }), 403);
      assert.equal(await statusWith({ Origin: 'https://evil.example' }), 403);
      assert.equal(await statusWith({ Origin: client.origin.replace('https', 'http') }), 403, 'the same without TLS is another origin');
      assert.equal(await statusWith({ Origin: `https://${kSite}` }), 403, 'and so is another port');
      assert.equal(await statusWith({ Origin: 'null' }), 403);
    });

    test('by HTTP/2 the page is known too', async (t) => {
      const client = clientOf(t);
      const statusOf = (Origin) => statusByHttp2(client, 'POST', '/v1/renders', { Origin, ...kPng }, kScene);
      assert.equal(await statusOf(client.origin), 200);
      assert.equal(await statusOf('https://evil.example'), 403);
    });

    test('a name that is not ours reaches nothing', async (t) => {
      const client = clientOf(t);
      const { status, headers } = await client.ask('GET', '/v1/limits', { headers: { Host: 'evil.example' } });
      assert.equal(status, 421);
      assert.equal(headers['request-id'], undefined, 'the proxy says so, not the server');
    });

    test('a job is found by its Location, under the path too, and so is its picture', async (t) => {
      const client = clientOf(t);
      for (const base of ['', '/render']) {
        const accepted = await client.ask('POST', `${base}/v1/renders`, { body: kScene });
        assert.equal(accepted.status, 202);
        const { location } = accepted.headers;
        assert.ok(location.startsWith(`${base}/v1/renders/`), location);
        let job;
        do job = await client.json('GET', location, { headers: { Prefer: 'wait=5' } }); while (job.state !== 'done');
        assert.equal(job.image_url, `${location}/image`);
        assert.equal((await client.ask('GET', job.image_url)).headers['content-type'], 'image/png');
        const scene = await client.ask('POST', `${base}/v1/scenes`, { body: kScene });
        assert.equal((await client.ask('GET', scene.headers.location)).status, 200);
        const list = await client.ask('GET', `${base}/v1/renders?limit=1`);
        if (base) assert.ok(list.headers.link.startsWith('</render/v1/renders?'), list.headers.link);
        assert.equal((await client.json('GET', `${base}/openapi.json`)).servers[0].url, base || '/');
      }
    });

    test('an encoded separator is data of its segment, under the path too', async (t) => {
      const client = clientOf(t);
      for (const base of ['', '/render']) {
        assert.equal((await client.ask('GET', `${base}/v1/limits`)).status, 200);
        assert.equal((await client.ask('GET', `${base}/v1%2Flimits`)).status, 404);
      }
    });

    test('events come as they happen, and the stream ends with the render', async (t) => {
      const client = clientOf(t);
      const { headers: { location } } = await client.ask('POST', '/v1/renders', { body: kEndless });
      const stream = await client.open('GET', `${location}/events`);
      assert.equal(stream.headers['content-type'], 'text/event-stream');
      let text = '';
      for await (const chunk of stream) {
        const isFirst = text === '';
        text += chunk;
        if (isFirst) await client.ask('DELETE', location);  // it would run for minutes: this chunk did not wait for the end
      }
      t.diagnostic(`${name} GET ${location}/events  ->  ${[...text.matchAll(/^event: (\w+)$/gm)].map((it) => it[1]).join(', ')}`);
      assert.match(text, /^event: state\n/);
      assert.match(text, /event: done\nid: end\ndata: .*"state":"cancelled"/);
    });

    test('a session shows its views', async (t) => {
      const client = clientOf(t);
      const session = await client.ask('POST', '/render/v1/sessions', { headers: { Origin: client.origin }, body: kScene });
      assert.equal(session.status, 201);
      const { location } = session.headers;
      const view = { seq: 1, camera: { position: [0, 1, 7] }, image: { width: 24, height: 16 }, moving: false };
      assert.equal((await client.ask('PUT', `${location}/view`, { headers: { Origin: client.origin }, body: view })).status, 204);
      let frame;
      do {
        const after = frame?.headers['frame-seq'] ?? 0;
        frame = await client.ask('GET', `${location}/frame?after=${after}`, { headers: kPng });
        assert.ok([200, 204].includes(frame.status));
      } while (frame.headers['view-seq'] !== '1');
      assert.equal(frame.body.readUInt32BE(16), 24, 'the width of the PNG');
      assert.equal((await client.ask('DELETE', location)).status, 204);
    });

    test('40 clients that ask to wait for a minute all get a job before the proxy gives up, and it goes on', async (t) => {
      const client = clientOf(t);
      client.say = () => {};
      const cancelled = await metric(server, 'tilelight_renders_total{state="cancelled"}');
      const answers = await Promise.all(Array.from({ length: 40 }, () => client.ask('POST', '/v1/renders', { headers: { ...kPng, Prefer: 'wait=60' }, body: kEndless })));
      const statuses = answers.map((answer) => answer.status);
      t.diagnostic(`${name} 40 x POST /v1/renders | prefer: wait=60  ->  ${statuses.join(' ')}`);
      assert.deepEqual(new Set(statuses), new Set([202]));
      assert.equal(new Set(answers.map((answer) => answer.headers.location)).size, 40, 'each has its own');
      for (const { headers } of answers) {
        assert.equal(headers['preference-applied'], `wait=${kWaitS}`);
        assert.equal((await client.json('GET', headers.location)).state, 'running');
      }
      assert.equal(await metric(server, 'tilelight_renders_total{state="cancelled"}'), cancelled);
      for (const { headers } of answers) assert.equal((await client.ask('DELETE', headers.location)).status, 204);
    });

    test('every other request that waits is answered within the wait too', async (t) => {
      const client = clientOf(t);
      const wait = { Prefer: 'wait=60' };
      const { headers: { location } } = await client.ask('POST', '/v1/renders', { body: kEndless });
      const status = await client.json('GET', location);
      const poll = await client.ask('GET', location, { headers: { ...wait, 'If-None-Match': `W/"${status.revision + 1000}"` } });
      assert.equal(poll.status, 200);
      assert.equal(poll.headers['preference-applied'], `wait=${kWaitS}`);
      const scene = await client.json('POST', '/v1/scenes', { body: kEndless });
      const image = await client.ask('GET', `/v1/scenes/${scene.id}/image?format=png`, { headers: wait });
      assert.equal(image.status, 202);
      assert.equal(image.headers['cache-control'], 'no-store');
      const session = await client.json('POST', '/v1/sessions', { body: kScene });
      const frame = await client.ask('GET', `/v1/sessions/${session.id}/frame?after=1000`, { headers: wait });
      assert.equal(frame.status, 204);
      assert.equal(frame.headers['preference-applied'], `wait=${kWaitS}`);
      for (const path of [location, image.headers.location, `/v1/sessions/${session.id}`]) await client.ask('DELETE', path);
    });

    test('clients are told apart by their own addresses, and nobody can say that he is another', async (t) => {
      const [one, two] = [clientOf(t, '127.0.0.2'), clientOf(t, '127.0.0.3')];
      const order = (client, headers, seed) => client.ask('POST', '/v1/renders', { headers, body: { ...kScene, render: { samples: 1, seed } } });
      const key = { 'Idempotency-Key': `key of ${name}` };
      const first = await order(one, key, 1);
      const second = await order(two, key, 2);
      assert.equal(second.status, 202, 'the key of another client is another key');
      assert.equal((await order(one, key, 2)).status, 422, 'and of the same the same');
      const listOf = async (client, headers = {}) => (await client.json('GET', '/v1/renders', { headers })).renders.map((it) => it.id);
      const id = first.headers.location.split('/').pop();
      assert.ok((await listOf(one)).includes(id));
      for (const lie of ['127.0.0.2', '127.0.0.2, 127.0.0.1', '127.0.0.2, nonsense', '127.0.0.2:80', '[::ffff:127.0.0.2]:80']) {
        const seen = await listOf(two, { 'X-Forwarded-For': lie, Forwarded: 'for=127.0.0.2', 'X-Real-IP': '127.0.0.2' });
        assert.ok(!seen.includes(id), lie);
        assert.ok(seen.includes(second.headers.location.split('/').pop()), lie);
      }
      const direct = new Client({ port: server.port, from: '127.0.0.3' });
      assert.ok(!(await listOf(direct, { 'X-Forwarded-For': '127.0.0.2' })).includes(id), 'who comes past the proxy is not believed');
      assert.match(server.output(), /"client":"127\.0\.0\.2"/, 'the log has the address too');
    });
  });
}
