// SPDX-License-Identifier: Apache-2.0
// Pictures of stored scenes through caches: rendered once, whoever asks, however he asks.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { startServer } from '../support/server.mjs';
import { kSite, startDocumentedNginx, startDocumentedVarnish, startNginx, startPlainVarnish } from '../support/proxies.mjs';
import { Client, metric } from './client.mjs';

const kDone = 'tilelight_renders_total{state="done"}';
const kAsked = 'tilelight_http_requests_total{route="/v1/scenes/{id}/image",status="200"}';
const kAccepts = [
  undefined, '*/*', 'image/png', 'image/avif,image/webp,image/apng,image/svg+xml,image/*,*/*;q=0.8',
  'image/avif,image/webp,image/png,image/svg+xml,image/*;q=0.8,*/*;q=0.5', 'text/html,application/xhtml+xml,*/*;q=0.8',
];

// nginx's own rules and nothing else.
const startPlainNginx = (server) => startNginx(({ folder, port }) => `proxy_cache_path ${folder}/cache keys_zone=plain:1m;
  server { listen 127.0.0.1:${port}; location / { proxy_pass http://127.0.0.1:${server.port}; proxy_cache plain; } }`);

// base: the path under which the proxy has the server. takesLists: Varnish compares If-None-Match with the one tag that
// it has, and answers a list of tags with the picture.
for (const { name, startCache, host, base = '', isDocumented = false, takesLists = true } of [
  { name: 'nginx of docker/proxies', startCache: startDocumentedNginx, host: kSite, isDocumented: true },
  { name: 'nginx of docker/proxies, under its path', startCache: startDocumentedNginx, host: kSite, base: '/render', isDocumented: true },
  { name: 'nginx by its own rules', startCache: startPlainNginx },
  { name: 'Varnish of docker/proxies', startCache: startDocumentedVarnish, isDocumented: true, takesLists: false },
  { name: 'Varnish by its own rules', startCache: startPlainVarnish, takesLists: false },
]) {
  describe(`through ${name}`, () => {
    let server;
    let cache;
    let scenes = 0;
    before(async () => {
      // Nothing kept by the server itself: what is counted here is what the cache asks it for.
      server = await startServer(['--allowed-hosts', kSite, '--trusted-proxy', '127.0.0.1', '--pictures-mb', '0']);
      cache = await startCache(server);
    });
    after(async () => {
      await cache?.stop();
      await server?.stop();
    });

    // A client, and the path of the picture of a scene that nobody has asked for yet, with and without the base.
    async function newPicture(t) {
      const client = new Client({ port: cache.port, host, say: (line) => t.diagnostic(line) });
      const scene = { objects: [{ type: 'sphere', radius: 1 + scenes++ }], image: { width: 8, height: 8 }, render: { samples: 1 } };
      const { id } = await client.json('POST', '/v1/scenes', { body: scene });
      const ownPath = `/v1/scenes/${id}/image`;
      return { client, path: base + ownPath, ownPath };
    }
    // How many renders `body` costs.
    async function rendersOf(body) {
      const before = await metric(server, kDone);
      await body();
      return await metric(server, kDone) - before;
    }

    test('five conditional GETs are one render', async (t) => {
      const { client, path, ownPath } = await newPicture(t);
      const direct = new Client({ port: server.port });
      for (const query of ['?samples=1', '?samples=2&format=png']) {
        const { headers: { etag } } = await direct.ask('GET', ownPath + query);  // known without the cache
        const renders = await rendersOf(async () => {
          for (const tags of [etag, `W/${etag}`, `"other", ${etag}`, `"a,b" ,W/${etag}`, etag]) {
            const { status } = await client.ask('GET', path + query, { headers: { 'If-None-Match': tags } });
            assert.equal(status, takesLists || !tags.includes(',') ? 304 : 200, tags);
          }
        });
        assert.ok(renders <= 1, `${renders} renders`);
      }
    });

    test('five GETs are one render, the same bytes, and HEAD is none', async (t) => {
      const { client, path } = await newPicture(t);
      const renders = await rendersOf(async () => {
        const first = await client.ask('GET', path);
        assert.equal(first.headers['cache-control'], 'public, max-age=31536000, immutable');
        for (let i = 0; i < 4; ++i) assert.deepEqual((await client.ask('GET', path)).body, first.body);
        assert.equal((await client.ask('HEAD', path)).headers.etag, first.headers.etag);
      });
      assert.equal(renders, 1);
    });

    test('no spelling of Accept costs another render where the address names the format', async (t) => {
      const { client, path } = await newPicture(t);
      const renders = await rendersOf(async () => {
        for (const Accept of kAccepts) {
          const answer = await client.ask('GET', `${path}?format=png`, { headers: Accept ? { Accept } : {} });
          assert.equal(answer.headers['content-type'], 'image/png');
          assert.equal(answer.headers.vary, undefined);
        }
      });
      assert.equal(renders, 1);
    });

    test('the format that Accept asks for is the one that comes, and each is rendered once', async (t) => {
      const { client, path } = await newPicture(t);
      const renders = await rendersOf(async () => {
        for (const Accept of ['image/png', 'image/jpeg', 'image/x-exr', 'image/jpeg', 'image/png', 'image/x-exr']) {
          const answer = await client.ask('GET', path, { headers: { Accept } });
          assert.equal(answer.headers['content-type'], Accept);
        }
      });
      assert.equal(renders, 3);
    });

    if (isDocumented) {
      test('all spellings of Accept that mean PNG share one copy', async (t) => {
        const { client, path } = await newPicture(t);
        const before = await metric(server, kAsked);
        for (const Accept of kAccepts) {
          const answer = await client.ask('GET', path, { headers: Accept ? { Accept } : {} });
          assert.equal(answer.headers['content-type'], 'image/png');
        }
        assert.equal(await metric(server, kAsked) - before, 1);
      });
    }

    test('errors are not kept: what was missing or wrong is asked for again', async (t) => {
      const { client, path } = await newPicture(t);
      for (const [bad, status] of [[`${base}/v1/scenes/${'0'.repeat(64)}/image`, 404], [`${path}?width=0`, 422], [`${path}?format=gif`, 422]]) {
        const counter = `tilelight_http_requests_total{route="/v1/scenes/{id}/image",status="${status}"}`;
        const before = await metric(server, counter);
        for (let i = 0; i < 2; ++i) {
          const answer = await client.ask('GET', bad);
          assert.equal(answer.status, status);
          assert.equal(answer.headers['cache-control'], 'no-store');
        }
        assert.equal(await metric(server, counter) - before, 2);
      }
    });
  });
}

test('the server itself renders a picture once for all spellings of Accept', async () => {
  const server = await startServer();
  try {
    const client = new Client({ port: server.port });
    const { id } = await client.json('POST', '/v1/scenes', { body: { objects: [{ type: 'sphere' }], image: { width: 8, height: 8 } } });
    const bodies = [];
    for (const Accept of kAccepts) {
      const answer = await client.ask('GET', `/v1/scenes/${id}/image`, { headers: Accept ? { Accept } : {} });
      assert.match(answer.headers['render-info'], /^spp=/);
      bodies.push(answer.body);
    }
    for (const body of bodies) assert.deepEqual(body, bodies[0]);
    assert.equal(await metric(server, kDone), 1);
  } finally {
    await server.stop();
  }
});
