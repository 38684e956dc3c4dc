// SPDX-License-Identifier: Apache-2.0
// The picture and the hand: what is shown, how it moves, and that the newest view wins.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { after, before, test } from 'node:test';
import { afterMoving, finished, kDesktop, kPhone, kQuickScene, kSmall, look, onPage, shoot, startServer } from './harness.mjs';

let server;
before(async () => { server = await startServer(); });
after(() => server.stop());

const kMiddle = { x: 380, y: 250 };
const kHome = JSON.parse(await readFile(new URL('../../web/scenes/cubes.json', import.meta.url), 'utf8')).camera;
const distanceOf = ({ position, target }) => Math.hypot(...position.map((x, i) => x - target[i]));

async function drag(page, dx, dy, { button = 'left', steps = 12 } = {}) {
  await page.mouse.move(kMiddle.x, kMiddle.y);
  await page.mouse.down({ button });
  await page.mouse.move(kMiddle.x + dx, kMiddle.y + dy, { steps });
  await page.mouse.up({ button });
}

// The views that the page sends from now on.
function sentViews(page) {
  const views = [];
  page.on('request', (request) => {
    if (request.method() === 'PUT') views.push(request.postDataJSON());
  });
  return views;
}

for (const colorScheme of ['dark', 'light']) {
  test(`the page shows the opening in full size, ${colorScheme}`, async () => {
    await onPage({ server, settings: { ...kDesktop, colorScheme } }, async ({ page }) => {
      assert.match(await look(page), /^1440x900:/);
      assert.match(await page.textContent('#status-main'), /16 samples/);
      const isVaried = await page.evaluate(() => {
        const context = new OffscreenCanvas(90, 56).getContext('2d');
        context.drawImage(document.getElementById('picture'), 0, 0, 90, 56);
        return new Set(new Uint32Array(context.getImageData(0, 0, 90, 56).data.buffer)).size > 50;
      });
      assert.ok(isVaried, 'there is something in the picture');
      await shoot(page, `desktop-${colorScheme}`);
    });
  });
}

test('a drag with the left button orbits and keeps the target', async () => {
  await onPage({ server, path: kQuickScene }, async ({ page }) => {
    const views = sentViews(page);
    await afterMoving(page, () => drag(page, 160, 30));
    const { position, target } = views.at(-1).camera;
    assert.deepEqual(target, kHome.target);
    assert.ok(position[1] > kHome.position[1], 'a drag down lifts the camera');
    await shoot(page, 'small-orbited');
  });
});

test('a drag with the right button pans', async () => {
  await onPage({ server, path: kQuickScene }, async ({ page }) => {
    const views = sentViews(page);
    await afterMoving(page, () => drag(page, -120, 0, { button: 'right' }));
    const { position, target } = views.at(-1).camera;
    const shift = target[0] - kHome.target[0];
    assert.ok(shift > 0.4, 'a drag to the left brings what is on the right');
    assert.ok(Math.abs(position[0] - kHome.position[0] - shift) < 1e-3, 'camera and target go together');
  });
});

test('the wheel zooms to the cursor', async () => {
  await onPage({ server, path: kQuickScene }, async ({ page }) => {
    const views = sentViews(page);
    await page.mouse.move(600, 160);
    await afterMoving(page, () => page.mouse.wheel(0, -400));
    const { camera } = views.at(-1);
    assert.ok(distanceOf(camera) < 0.8 * distanceOf(kHome), 'nearer than before');
    assert.ok(camera.target[0] > kHome.target[0], 'the target goes toward the cursor');
  });
});

test('arrow keys move the picture that has the focus, and R goes back', async () => {
  await onPage({ server, path: kQuickScene }, async ({ page }) => {
    const first = await look(page);
    await page.focus('#picture');
    await afterMoving(page, () => page.keyboard.press('ArrowLeft'));
    await afterMoving(page, () => page.keyboard.press('Shift+ArrowUp'));
    await afterMoving(page, () => page.keyboard.press('+'));
    assert.notEqual(await look(page), first);
    await afterMoving(page, () => page.keyboard.press('r'));
    assert.equal(await look(page), first, 'the same view gives the same pixels');
  });
});

test('while moving the picture is smaller, and at rest it is whole', async () => {
  await onPage({ server, path: kQuickScene }, async ({ page }) => {
    const views = sentViews(page);
    await afterMoving(page, () => drag(page, 200, 0, { steps: 40 }));
    const moving = views.filter((view) => view.moving);
    assert.ok(moving.length >= 2, `${moving.length} moving views`);
    assert.ok(moving.every(({ image }) => image.width <= 768));
    assert.equal(views.at(-1).moving, false);
    assert.deepEqual(views.at(-1).image, kSmall.viewport);
  });
});

test('frames never go back to an older view, and the newest view is the one that stays', async () => {
  await onPage({ server, path: kQuickScene }, async ({ page }) => {
    const views = sentViews(page);
    const frames = [];
    page.on('response', (response) => {
      const seq = response.headers()['view-seq'];
      if (seq) frames.push(Number(seq));
    });
    await afterMoving(page, async () => {
      for (const dx of [200, -240, 180, -90]) await drag(page, dx, dx / 5, { steps: 6 });
    });
    assert.deepEqual(frames, [...frames].sort((a, b) => a - b));
    assert.equal(frames.at(-1), views.at(-1).seq);
    const seqs = views.map(({ seq }) => seq);
    assert.deepEqual(seqs, [...new Set(seqs)].sort((a, b) => a - b), 'each view has a higher number than the last');
  });
});

test('a session that the server has forgotten is opened anew', async () => {
  await onPage({ server, path: kQuickScene, expected: [/404/, /410/] }, async ({ page }) => {
    const [put] = await Promise.all([
      page.waitForRequest((request) => request.method() === 'PUT'),
      drag(page, 40, 0),
    ]);
    await finished(page);
    await page.request.delete(put.url().replace(/\/view$/, ''));
    const opened = page.waitForRequest((request) => request.method() === 'POST' && request.url().endsWith('/v1/sessions'));
    await afterMoving(page, () => drag(page, 90, 0));
    await opened;
    assert.equal(await page.isVisible('#notice'), false);
  });
});

test('without the server the last picture stays, and the page goes on when it is back', async () => {
  await onPage({ server, path: kQuickScene, expected: [/ERR_INTERNET_DISCONNECTED/] }, async ({ page, context }) => {
    const first = await look(page);
    const glanced = await page.evaluate(() => window.glance());
    await context.setOffline(true);
    await drag(page, 150, 0);
    await page.waitForSelector('#notice:has-text("cannot be reached")');
    assert.equal(await look(page), first);
    await shoot(page, 'small-offline');
    await context.setOffline(false);
    await page.waitForSelector('#notice', { state: 'hidden' });
    await page.waitForFunction((old) => window.glance() !== old, glanced, { polling: 100 });
  });
});

test('one finger orbits and two fingers zoom', async () => {
  await onPage({ server, settings: { ...kPhone, deviceScaleFactor: 1 }, path: kQuickScene }, async ({ page, context }) => {
    const views = sentViews(page);
    const touch = await context.newCDPSession(page);
    const send = (type, ...points) => touch.send('Input.dispatchTouchEvent', {
      type, touchPoints: points.map(([x, y], id) => ({ x, y, id })),
    });
    await afterMoving(page, async () => {
      await send('touchStart', [180, 360]);
      for (let x = 180; x <= 260; x += 10) await send('touchMove', [x, 360]);
      await send('touchEnd');
    });
    const orbited = views.at(-1).camera;
    assert.deepEqual(orbited.target, kHome.target);
    await afterMoving(page, async () => {
      await send('touchStart', [150, 370], [210, 370]);
      for (let d = 0; d <= 60; d += 10) await send('touchMove', [150 - d, 370], [210 + d, 370]);
      await send('touchEnd');
    });
    assert.ok(distanceOf(views.at(-1).camera) < 0.6 * distanceOf(orbited), 'fingers that spread come nearer');
  });
});
