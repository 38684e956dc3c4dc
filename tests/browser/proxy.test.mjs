// SPDX-License-Identifier: Apache-2.0
// The page through nginx: under a path by a bare proxy_pass, and with TLS under a name by the file of docker/proxies.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { kSite, startDocumentedNginx, startNginx } from '../support/proxies.mjs';
import { afterMoving, compared, look, onPage, openPanel, startServer } from './harness.mjs';

let server;
before(async () => { server = await startServer(['--allowed-hosts', kSite, '--trusted-proxy', '127.0.0.1']); });
after(() => server?.stop());

// Orbits, compares two methods (jobs, waited for and fetched) and opens the plan; what the page asked for, by path.
async function useThePage(page) {
  const asked = [];
  page.on('request', (request) => asked.push(new URL(request.url()).pathname));
  const before = await look(page);
  await afterMoving(page, () => page.keyboard.press('Shift+ArrowLeft'));
  assert.notEqual(await look(page), before);
  await openPanel(page, 'method');
  await page.check('#compare-toggle');
  await compared(page);
  await openPanel(page, 'plan');
  await page.waitForFunction(() => document.getElementById('plan-body').textContent.length > 40);
  return asked;
}

test('under a path that a bare proxy_pass takes off, all that the page does stays under the path', async () => {
  const nginx = await startNginx(({ port }) => `server {
    listen 127.0.0.1:${port};
    location /render/ { proxy_pass http://127.0.0.1:${server.port}/; }
    location / { return 404; }
  }`);
  try {
    const under = { url: `http://127.0.0.1:${nginx.port}/render` };
    await onPage({ server: under, path: '/#scene=cubes' }, async ({ page }) => {
      await page.focus('#picture');
      const asked = await useThePage(page);
      assert.ok(asked.some((path) => /^\/render\/v1\/renders\/[^/]+\/image$/.test(path)), 'a job of its own was fetched');
      for (const path of asked) assert.ok(path.startsWith('/render/'), path);
      await page.evaluate(() => Object.defineProperty(navigator, 'clipboard', { value: { writeText: async (text) => { window.copied = text; } } }));
      await page.click('#curl-button');
      await page.waitForFunction(() => window.copied);
      assert.ok((await page.evaluate(() => window.copied)).includes(`'${under.url}/v1/renders'`), 'the command asks under the path too');
    });
  } finally {
    await nginx.stop();
  }
});

test('with TLS, under a name of its own, the page works at the root and under a path', async () => {
  const nginx = await startDocumentedNginx(server);
  try {
    for (const base of ['', '/render']) {
      const site = { url: `https://${kSite}:${nginx.port}${base}` };
      const settings = { viewport: { width: 480, height: 320 }, ignoreHTTPSErrors: true };
      const flags = [`--host-resolver-rules=MAP ${kSite} 127.0.0.1`];
      await onPage({ server: site, path: '/#scene=cubes', settings, flags }, async ({ page }) => {
        await page.focus('#picture');
        for (const path of await useThePage(page)) assert.ok(path.startsWith(`${base}/`), path);
      });
    }
  } finally {
    await nginx.stop();
  }
});
