// SPDX-License-Identifier: Apache-2.0
// A server on a free port, a browser with a fresh profile, and pages that keep account of what went wrong in them.
import assert from 'node:assert/strict';
import { mkdir, mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { chromium } from 'playwright-core';

export { startServer } from '../support/server.mjs';

const kBrowserFlags = [
  '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync',
];
const kShots = new URL('./shots/', import.meta.url).pathname;
const kPatienceMs = 180_000;  // a finished picture on a busy machine

export const kSmall = { viewport: { width: 768, height: 480 } };  // what most tests need; a picture of it is quick
export const kQuickScene = '/#scene=cubes';  // drawn in a fifth of the opening's time; for what does not depend on the scene
export const kDesktop = { viewport: { width: 1440, height: 900 } };
export const kPhone = { viewport: { width: 360, height: 740 }, deviceScaleFactor: 2, hasTouch: true, isMobile: true };

// Runs `body({page, server, context})` on a loaded page with a finished first picture, and holds the page to a clean
// console: no errors, no exceptions, no breach of the content security policy. `expected` = patterns of console lines
// that the test provokes; `flags` = more of the browser's.
export async function onPage({ server, settings = kSmall, path: where = '/', expected = [], flags = [] }, body) {
  const profile = await mkdtemp(path.join(tmpdir(), 'tilelight-browser-'));
  const context = await chromium.launchPersistentContext(profile, {
    executablePath: process.env.CHROMIUM, args: [...kBrowserFlags, ...flags], headless: true, ...settings,
  });
  try {
    const page = context.pages()[0];
    page.setDefaultTimeout(kPatienceMs);
    const complaints = watch(page, expected, new URL(server.url).hostname);
    await context.addInitScript(installEyes);
    await page.goto(server.url + where);
    await finished(page);
    await body({ page, server, context });
    assert.deepEqual(complaints, [], 'the console is clean');
  } finally {
    await context.close();
    await rm(profile, { recursive: true, force: true });
  }
}

function watch(page, expected, host) {
  const complaints = [];
  const complain = (text) => expected.some((pattern) => pattern.test(text)) || complaints.push(text);
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && complain(message.text()));
  page.on('pageerror', (error) => complain(String(error.stack ?? error)));
  page.on('request', (request) => {
    const { protocol, hostname } = new URL(request.url());
    if (protocol.startsWith('http') && hostname !== host) complain(`asked another host: ${request.url()}`);
  });
  return complaints;
}

// Until the newest view has its last frame on the screen.
export async function finished(page) {
  await page.waitForFunction(() => document.getElementById('progress').getAttribute('aria-valuenow') === '100');
}

// Makes a movement and waits for the finished picture of its end.
export async function afterMoving(page, move) {
  const before = await page.evaluate(() => window.glance());
  await move();
  await page.waitForFunction((old) => window.glance() !== old, before, { polling: 100 });
  await finished(page);
}

// Until both pictures of a comparison are there, and the numbers about them.
export async function compared(page) {
  await page.waitForFunction(() => /^Drawn with/.test(document.getElementById('compare-state').textContent)
    && document.getElementById('compare-differing').textContent !== '–');
}

export async function openPanel(page, name) {
  await page.click(`#${name}-button`);
  await page.waitForSelector(`#${name}-panel`);
}

// A fingerprint of what the canvas shows: equal strings mean equal pixels.
export function look(page) {
  return page.evaluate(() => window.lookAt(document.getElementById('picture')));
}

// The fingerprint of a PNG's pixels.
export function lookOfPng(page, bytes) {
  return page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    return window.lookAt(await createImageBitmap(new Blob([bytes], { type: 'image/png' })));
  }, bytes.toString('base64'));
}

// Runs in every page. lookAt: size and FNV-1a hash of an image's colours; glance: of a small copy of the picture, which
// is enough to see that something moved.
function installEyes() {
  window.lookAt = (image, width = image.width, height = image.height) => {
    const context = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true });
    context.drawImage(image, 0, 0, width, height);
    const { data } = context.getImageData(0, 0, width, height);
    let hash = 0x811c9dc5;
    for (let i = 0; i < data.length; i += 4) {
      hash = Math.imul(hash ^ ((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]), 0x01000193);
    }
    return `${width}x${height}:${hash >>> 0}`;
  };
  window.glance = () => window.lookAt(document.getElementById('picture'), 72, 45);
}

export async function shoot(page, name) {
  await mkdir(kShots, { recursive: true });
  await page.screenshot({ path: path.join(kShots, `${name}.png`) });
}
