// SPDX-License-Identifier: Apache-2.0
// Scenes and gestures at the limits: far from the origin, tiny, huge, from straight above; a wheel with Ctrl, a screen of
// another pixel ratio, views that are refused.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { after, before, test } from 'node:test';
import { encodeLink } from '../../web/js/share.js';
import { afterMoving, finished, kQuickScene, look, lookOfPng, onPage, openPanel, shoot, startServer } from './harness.mjs';

let server;
before(async () => { server = await startServer(); });
after(() => server.stop());

const kInputs = new URL('../cases/inputs/', import.meta.url);
const input = (name) => readFile(new URL(`${name}.json`, kInputs), 'utf8');
const kRefused = [/422/];  // the browser logs every refused request; here they are asked for
const kNotch = Math.exp(0.11);

// A window of 8:5 in which a movement is made at once, so that what is sent last is what was asked for.
const kWindow = { viewport: { width: 640, height: 400 }, reducedMotion: 'reduce' };
const kMiddle = { x: 320, y: 200 };
const linkTo = async (scene, camera) => `/${await encodeLink({ text: typeof scene === 'string' ? scene : JSON.stringify(scene), camera })}`;

const distanceOf = ({ position, target }) => Math.hypot(...position.map((x, i) => x - target[i]));
const assertNear = (a, b, tolerance) => assert.ok(Math.abs(a - b) <= tolerance * Math.abs(b), `${a} is not ${b}`);

// The views that the page sends from now on.
function sentViews(page) {
  const views = [];
  page.on('request', (request) => request.method() === 'PUT' && views.push(request.postDataJSON()));
  return views;
}

// The fingerprint of what POST /v1/renders makes of a document.
async function lookOfRender(page, document, image = kWindow.viewport) {
  const answer = await page.request.post(`${server.url}/v1/renders`, {
    data: { ...document, image: { ...document.image, ...image } }, headers: { Accept: 'image/png', Prefer: 'wait=30' },
  });
  assert.equal(answer.status(), 200, await answer.text().catch(() => ''));
  return lookOfPng(page, await answer.body());
}

async function drag(page, dx, dy) {
  await page.mouse.move(kMiddle.x, kMiddle.y);
  await page.mouse.down();
  await page.mouse.move(kMiddle.x + dx, kMiddle.y + dy);
  await page.mouse.up();
}

// Turns the wheel in the picture's middle by so many events of `px`, all before the next picture is asked for.
function turnWheel(page, px, times = 1) {
  return page.evaluate(({ x, y, deltaY, count }) => {
    const canvas = document.getElementById('picture');
    for (let i = 0; i < count; ++i) canvas.dispatchEvent(new WheelEvent('wheel', { deltaY, clientX: x, clientY: y, cancelable: true }));
  }, { ...kMiddle, deltaY: px, count: times });
}

const isQuiet = async (page) => assert.equal(await page.isVisible('#notice'), false, await page.textContent('#notice-text'));

for (const name of ['page-far-from-the-origin', 'page-map-coordinates']) {
  test(`${name}: the editor's scene is the picture that a POST gives, and the hand goes around it`, async () => {
    const text = await input(name);
    const { width, height } = JSON.parse(text).image;
    const viewport = { width: 2 * width, height: 2 * height };
    await onPage({ server, settings: { ...kWindow, viewport }, path: kQuickScene }, async ({ page }) => {
      const views = sentViews(page);
      await openPanel(page, 'edit');
      await afterMoving(page, () => page.fill('#editor-text', text));
      const first = await look(page);
      assert.equal(first, await lookOfRender(page, JSON.parse(text), viewport));
      const home = views.at(-1).camera;
      await page.focus('#picture');
      for (let i = 0; i < 4; ++i) await afterMoving(page, () => page.keyboard.press(i % 2 ? 'Shift+ArrowUp' : 'Shift+ArrowLeft'));
      const turned = views.at(-1).camera;
      assert.deepEqual(turned.target, home.target);
      assertNear(distanceOf(turned), distanceOf(home), 1e-8);
      assert.equal(await look(page), await lookOfRender(page, { ...JSON.parse(text), camera: turned }, viewport));
      await shoot(page, name);
      await afterMoving(page, () => page.keyboard.press('ArrowLeft'));
      await afterMoving(page, () => page.keyboard.press('+'));
      await isQuiet(page);
      assert.equal(await page.inputValue('#editor-text'), text);
      await afterMoving(page, () => page.keyboard.press('r'));
      assert.equal(await look(page), first);
    });
  });
}

test('a camera of seventeen digits is sent with all of them, and comes back from the link, the curl line and a comparison', async () => {
  const camera = {
    type: 'perspective', position: [10000005.123456789, -6999997.987654321, 3000004.1000000001], target: [10000000.5, -7000000.1, 3000000.3],
    up: [0.1, 1, 1 / 3], fov_y_deg: 100 / 3,
  };
  const scene = JSON.stringify({ ...JSON.parse(await input('page-far-from-the-origin')), camera, image: kWindow.viewport });
  const settings = { ...kWindow, permissions: ['clipboard-read', 'clipboard-write'] };
  await onPage({ server, settings, path: await linkTo(scene) }, async ({ page, context }) => {
    const views = sentViews(page);
    const stills = [];
    page.on('request', (request) => request.url().endsWith('/v1/renders') && stills.push(request.postDataJSON().camera));
    const clipboard = async (button) => {
      await page.evaluate(() => navigator.clipboard.writeText(''));
      await page.click(button);
      await page.waitForFunction(async () => (await navigator.clipboard.readText()) !== '');
      return page.evaluate(() => navigator.clipboard.readText());
    };
    await page.focus('#picture');
    await afterMoving(page, () => page.keyboard.press('Shift+ArrowLeft'));
    await afterMoving(page, () => page.keyboard.press('r'));
    assert.deepEqual(views.at(-1).camera, camera);
    await afterMoving(page, () => page.keyboard.press('Shift+ArrowLeft'));
    const shown = views.at(-1).camera;
    const curl = JSON.parse((await clipboard('#curl-button')).split('\n').at(-3));
    assert.deepEqual(curl.camera, shown);
    const link = await clipboard('#link-button');
    assert.match(link, /&camera=p(,-?[\d.]+(e-?\d+)?){10}$/, 'plain numbers between commas');
    const other = await context.newPage();
    const restored = sentViews(other);
    await other.goto(link);
    await finished(other);
    assert.deepEqual(restored.map((view) => view.camera), restored.map(() => shown));
    assert.equal(await look(other), await look(page));
    await other.close();
    await openPanel(page, 'method');
    await page.check('#compare-toggle');
    await page.waitForFunction(() => /^Drawn with/.test(document.getElementById('compare-state').textContent));
    assert.deepEqual(stills, [shown, shown]);
  });
});

// Mean difference of two pictures over channels, in steps of 8 bits, in a size in which a pixel's drag hardly shows.
async function meanDifference(page, move) {
  const pixels = () => page.evaluate(() => {
    const context = new OffscreenCanvas(80, 50).getContext('2d', { willReadFrequently: true });
    context.drawImage(document.getElementById('picture'), 0, 0, 80, 50);
    return [...context.getImageData(0, 0, 80, 50).data];
  });
  const a = await pixels();
  await move();
  const b = await pixels();
  return a.reduce((sum, value, i) => sum + Math.abs(value - b[i]), 0) / (0.75 * a.length);
}

for (const [what, change] of [
  ['straight down', {}],
  ['straight up', { camera: { position: [0, -8, 0], target: [0, 0, 0] } }],
  ['straight down, orthographic', { camera: { type: 'orthographic', position: [0, 8, 0], height: 6 } }],
  ['along a z that is up', { camera: { position: [0, 0, 8], up: [0, 0, 1] } }],
]) {
  test(`a drag by one pixel from ${what} gives hardly another picture`, async () => {
    const scene = { ...JSON.parse(await input('page-straight-down')), ...change };
    await onPage({ server, settings: kWindow, path: await linkTo(scene) }, async ({ page }) => {
      const views = sentViews(page);
      const first = await look(page);
      assert.equal(first, await lookOfRender(page, scene));
      for (const [dx, dy] of [[1, 0], [0, 1], [-1, -1]]) {
        const difference = await meanDifference(page, () => afterMoving(page, () => drag(page, dx, dy)));
        assert.ok(difference < 2.5, `${difference} of 255 after a drag by ${dx}, ${dy}`);
        assert.ok(views.at(-1).camera.position.every(Number.isFinite));
        await page.focus('#picture');
        await afterMoving(page, () => page.keyboard.press('r'));
        assert.equal(await look(page), first);
      }
      await afterMoving(page, () => turnWheel(page, -100));
      const { position, target } = views.at(-1).camera;
      assert.equal(position.filter((x, i) => x !== target[i]).length, 1, 'a zoom stays on the axis');
    });
  });
}

test('the wheel zooms as far with a Ctrl key held as without, and a pinch on a trackpad as far as the fingers', async () => {
  await onPage({ server, settings: kWindow, path: kQuickScene }, async ({ page, context }) => {
    const views = sentViews(page);
    const devtools = await context.newCDPSession(page);
    const wheel = (deltaY, modifiers = 0) => devtools.send('Input.dispatchMouseEvent', { type: 'mouseWheel', ...kMiddle, deltaX: 0, deltaY, modifiers });
    const ratio = async (act) => {
      const before = views.at(-1) ? distanceOf(views.at(-1).camera) : null;
      await afterMoving(page, act);
      return before / distanceOf(views.at(-1).camera);
    };
    await page.mouse.move(kMiddle.x, kMiddle.y);
    await ratio(() => page.mouse.wheel(0, -100));
    assertNear(await ratio(() => page.mouse.wheel(0, -100)), kNotch, 1e-9);
    await page.keyboard.down('Control');
    assertNear(await ratio(() => page.mouse.wheel(0, -100)), kNotch, 1e-9);
    assertNear(await ratio(() => wheel(-12, 2)), Math.exp(0.0132), 1e-9);
    await page.keyboard.up('Control');
    assertNear(await ratio(() => wheel(-12, 2)), Math.exp(0.12), 1e-9);
    assertNear(await ratio(() => wheel(-0.75 * 16, 2)), Math.exp(0.12), 1e-9);
    assertNear(await ratio(() => wheel(100, 2)), 1 / kNotch, 1e-9);
  });
});

test('a Ctrl key that was pressed in another window is known by the movement of the pointer', async () => {
  await onPage({ server, settings: kWindow, path: kQuickScene }, async ({ page, context }) => {
    const views = sentViews(page);
    const devtools = await context.newCDPSession(page);
    const send = (type, rest) => devtools.send('Input.dispatchMouseEvent', { type, ...kMiddle, ...rest });
    await page.focus('#picture');
    await afterMoving(page, () => page.keyboard.press('+'));
    const before = distanceOf(views.at(-1).camera);
    await send('mouseMoved', { modifiers: 2 });
    await afterMoving(page, () => send('mouseWheel', { modifiers: 2, deltaX: 0, deltaY: -30 }));
    assertNear(before / distanceOf(views.at(-1).camera), Math.exp(0.033), 1e-9);
  });
});

test('another pixel ratio gives another picture at once, each time that it changes', async () => {
  await onPage({ server, settings: { ...kWindow, viewport: null, deviceScaleFactor: undefined }, path: kQuickScene }, async ({ page, context }) => {
    const devtools = await context.newCDPSession(page);
    const views = sentViews(page);
    for (const ratio of [1, 2, 1.25, 1.1, 1.75, 0.9, 1]) {
      await devtools.send('Emulation.setDeviceMetricsOverride', { width: 480, height: 300, deviceScaleFactor: ratio, mobile: false });
      const size = `${Math.round(480 * ratio)}x${Math.round(300 * ratio)}:`;
      await page.waitForFunction((wanted) => window.lookAt(document.getElementById('picture')).startsWith(wanted), size);
      await page.waitForFunction((wanted) => document.getElementById('status-size').textContent.replace(' × ', 'x') + ':' === wanted, size);
      await finished(page);
      assert.equal(`${views.at(-1).image.width}x${views.at(-1).image.height}:`, size);
    }
  });
});

const kFine = { image: { width: 640, height: 400 }, render: { samples: 1 } };
const cubeOf = (size, center = [0, 0, 0]) => ({ ...kFine, objects: [{ type: 'cube', size, center }] });

for (const [what, scene] of [
  ['a unit cube', cubeOf(1)],
  ['a cube of 1e-12', cubeOf(1e-12)],
  ['a cube of 1e15', cubeOf(1e15)],
  ['a floor without end', { ...kFine, objects: [{ type: 'plane', material: { diffuse: { checker: { a: 0.9, b: 0.1, size: 1 } } } }] }],
  ['a drawing of parallel rays', { ...cubeOf(1), camera: { type: 'orthographic', position: [3, 4, 5], height: 2 } }],
]) {
  test(`650 notches out of ${what}, 1300 in and back again: every view is drawn`, async () => {
    await onPage({ server, settings: kWindow, path: await linkTo(scene) }, async ({ page }) => {
      const views = sentViews(page);
      const first = await look(page);
      assert.equal(first, await lookOfRender(page, scene));
      await page.focus('#picture');
      for (const [px, times] of [[100, 650], [-100, 40], [-100, 1260], [100, 200]]) {
        await afterMoving(page, () => turnWheel(page, px, times));
        const { camera } = views.at(-1);
        const numbers = [...camera.position, ...camera.target, camera.height ?? camera.fov_y_deg];
        assert.ok(numbers.every((x) => typeof x === 'number' && Number.isFinite(x)), JSON.stringify(camera));
        assert.ok(distanceOf(camera) > 0);
        await isQuiet(page);
      }
      await page.keyboard.press('Shift+ArrowLeft');
      await page.click('#reset-button');
      await page.waitForFunction((wanted) => window.lookAt(document.getElementById('picture')) === wanted, first);
      await isQuiet(page);
    });
  });
}

// Makes a movement of which both views are refused, the one that moves and the one at rest.
async function moveToRefusal(page, move) {
  let refusals = 0;
  await new Promise((resolve, reject) => {
    page.route('**/view', async (route) => {
      await route.fulfill({ status: 422, contentType: 'application/problem+json', body: '{"title": "no", "detail": "found no number"}' });
      if (++refusals === 2) resolve();
    }, { times: 2 }).then(move).catch(reject);
  });
  await page.waitForSelector('#notice:has-text("This view cannot be drawn. found no number")');
}

for (const [what, mend] of [
  ['the next movement', (page) => page.keyboard.press('Shift+ArrowRight')],
  ['the way back', (page) => page.keyboard.press('r')],
  ['another scene', (page) => page.evaluate(() => { location.hash = '#scene=cubes&camera=p,33,9,4,2,0,1,0,0,1,0'; })],
]) {
  test(`what is said of a view that cannot be drawn goes with ${what}`, async () => {
    await onPage({ server, settings: kWindow, path: kQuickScene, expected: kRefused }, async ({ page }) => {
      await page.focus('#picture');
      await afterMoving(page, () => page.keyboard.press('Shift+ArrowRight'));
      await moveToRefusal(page, () => page.keyboard.press('Shift+ArrowLeft'));
      await afterMoving(page, () => mend(page));
      await isQuiet(page);
    });
  });
}

test('a link to where no camera can be is refused in words, and the scene\'s own camera is a key away', async () => {
  await onPage({ server, settings: kWindow, path: kQuickScene, expected: kRefused }, async ({ page }) => {
    const first = await look(page);
    await page.evaluate(() => { location.hash = '#scene=cubes&camera=p,33,1e31,4,2,0,1,0,0,1,0'; });
    await page.waitForSelector('#notice:has-text("This view cannot be drawn")');
    await shoot(page, 'small-refused-view');
    await page.click('#reset-button');
    await page.waitForSelector('#notice', { state: 'hidden' });
    await finished(page);
    assert.equal(await look(page), first);
  });
});

test('what is said of a scene that cannot be drawn goes with the next picture of the one before', async () => {
  await onPage({ server, settings: kWindow, path: kQuickScene, expected: kRefused }, async ({ page }) => {
    const bad = await linkTo('{"objects": [{"type": "sphere", "radius": -1}]}');
    await page.evaluate((hash) => { location.hash = hash.slice(1); }, bad);
    await page.waitForSelector('#notice:has-text("This scene cannot be drawn")');
    await page.focus('#picture');
    await afterMoving(page, () => page.keyboard.press('Shift+ArrowLeft'));
    await isQuiet(page);
  });
});

test('a scene that is edited while the hand is away from it keeps the view, unless it lies elsewhere then', async () => {
  await onPage({ server, settings: kWindow, path: await linkTo(cubeOf(1)) }, async ({ page }) => {
    const views = sentViews(page);
    await openPanel(page, 'edit');
    const edit = (scene) => afterMoving(page, () => page.fill('#editor-text', JSON.stringify(scene)));
    await edit(cubeOf(1.5));
    const own = views.at(-1).camera;
    assert.equal(await look(page), await lookOfRender(page, cubeOf(1.5)), 'a camera that nobody moved is the scene\'s own');
    await page.focus('#picture');
    await afterMoving(page, () => page.keyboard.press('Shift+ArrowLeft'));
    await afterMoving(page, () => turnWheel(page, 100, 650));
    const afar = views.at(-1).camera;
    assert.ok(distanceOf(afar) > 50 * distanceOf(own));
    await edit({ ...cubeOf(1.5), background: { bottom: [0, 0, 0.3], top: 0 } });
    assert.deepEqual(views.at(-1).camera, afar);
    await edit(cubeOf(1.5, [1e7, 0, 0]));
    assert.equal(await look(page), await lookOfRender(page, cubeOf(1.5, [1e7, 0, 0])));
  });
});

test('a FEN is sent as it was pasted, its line ends as spaces', async () => {
  const fen = '8/8/8/4k3/8/4K3/4P3/8\nb - - 0 1';
  const scene = { ...kFine, objects: [{ type: 'chess_position', fen: fen.replace('\n', ' '), detail: 8 }] };
  const settings = { ...kWindow, permissions: ['clipboard-read', 'clipboard-write'] };
  await onPage({ server, settings, path: await linkTo(scene), expected: kRefused }, async ({ page }) => {
    await openPanel(page, 'edit');
    assert.equal(await page.inputValue('#fen'), '8/8/8/4k3/8/4K3/4P3/8 b - - 0 1');
    await page.evaluate(() => navigator.clipboard.writeText(' 8/8/4k3/\r\n8/8/4K3/4P3/8\n\tw - - 0 1 \n'));
    await page.focus('#fen');
    await page.keyboard.press('Control+A');
    const [opened] = await Promise.all([
      page.waitForRequest((request) => request.method() === 'POST' && request.url().endsWith('/v1/sessions')),
      page.keyboard.press('Control+V'),
    ]);
    const pasted = ' 8/8/4k3/8/8/4K3/4P3/8 \tw - - 0 1  ';
    assert.equal(opened.postDataJSON().objects[0].fen, pasted);
    assert.equal(JSON.parse(await page.inputValue('#editor-text')).objects[0].fen, pasted);
    await page.keyboard.press('Control+Z');
    assert.equal(await page.inputValue('#fen'), '8/8/8/4k3/8/4K3/4P3/8 b - - 0 1');
  });
});

test('a finger that is lifted from three leaves the picture where it is', async () => {
  const settings = { ...kWindow, hasTouch: true, isMobile: true };
  await onPage({ server, settings, path: kQuickScene }, async ({ page, context }) => {
    const views = sentViews(page);
    const touch = await context.newCDPSession(page);
    const send = (type, ...points) => touch.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y, id]) => ({ x, y, id })) });
    await afterMoving(page, async () => {
      await send('touchStart', [200, 200, 0]);
      await send('touchMove', [210, 200, 0]);
      await send('touchMove', [220, 200, 0]);
    });
    const before = views.at(-1).camera;
    const count = views.length;
    await send('touchStart', [220, 200, 0], [400, 200, 1], [300, 300, 2]);
    for (let x = 220; x >= 100; x -= 20) await send('touchMove', [x, 200, 0], [400 + x, 200, 1], [300, 300, 2]);
    await send('touchEnd', [100, 200, 0], [500, 200, 1]);
    await send('touchMove', [100, 201, 0], [500, 201, 1]);
    await send('touchMove', [100, 202, 0], [500, 202, 1]);
    await page.waitForFunction(() => document.getElementById('progress').getAttribute('aria-valuenow') === '100');
    for (const { camera } of views.slice(count)) assertNear(distanceOf(camera), distanceOf(before), 0.02);
    await send('touchEnd');
  });
});
