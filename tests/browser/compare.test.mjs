// SPDX-License-Identifier: Apache-2.0
// The method of the picture, and two methods compared: by a divider, by their difference and by what they took.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { after, before, test } from 'node:test';
import { encodeLink } from '../../web/js/share.js';
import {
  afterMoving, compared, finished, kPhone, kQuickScene, kSmall, look, lookOfPng, onPage, openPanel, shoot, startServer,
} from './harness.mjs';

let server;
before(async () => { server = await startServer(); });
after(() => server.stop());

const kTiny = { viewport: { width: 480, height: 320 } };
const kDefaults = [{ algorithm: 'raytrace', shading: 'phong' }, { algorithm: 'zbuffer', shading: 'gouraud' }];
// One curved thing, so that shading rules can be told apart.
const kBall = `/${await encodeLink({ text: JSON.stringify({
  render: { samples: 4 }, objects: [{ type: 'sphere', material: { specular: 0.5 } }],
}) })}`;
const isRender = (request) => request.method() === 'POST' && request.url().endsWith('/v1/renders');

// The bodies of the renders that the page asks for from now on.
function sentRenders(page) {
  const bodies = [];
  page.on('request', (request) => isRender(request) && bodies.push(request.postDataJSON()));
  return bodies;
}

async function startComparing(page) {
  await openPanel(page, 'method');
  await page.check('#compare-toggle');
  await compared(page);
}

// Chooses a side's method and waits for the new pair.
async function choose(page, side, { algorithm, shading }) {
  for (const [key, word] of [['algorithm', algorithm], ['shading', shading]]) {
    if (await page.inputValue(`#compare-${key}-${side}`) === word) continue;
    await page.selectOption(`#compare-${key}-${side}`, word);
    await page.waitForFunction(() => document.getElementById('compare-differing').textContent === '–');
    await compared(page);
  }
}

// Keeps the two pictures of `bodies`, rendered apart from the page, in the page as window.pair: RGBA bytes.
async function fetchPair(page, bodies) {
  await page.evaluate(async (orders) => {
    window.pixels = (image) => {
      const context = new OffscreenCanvas(image.width, image.height).getContext('2d', { willReadFrequently: true });
      context.drawImage(image, 0, 0);
      return context.getImageData(0, 0, image.width, image.height).data;
    };
    window.pair = [];
    for (const body of orders) {
      const answer = await fetch('/v1/renders', { method: 'POST', body: JSON.stringify(body), headers: { 'Content-Type': 'application/json', Accept: 'image/png', Prefer: 'wait=60' } });
      window.pair.push(window.pixels(await createImageBitmap(await answer.blob())));
    }
  }, bodies.map(({ priority, ...body }) => body));
}

// Which columns of the comparison on show are those of A alone and of B alone; a column of neither is an error.
function columnsOnShow(page) {
  return page.evaluate(() => {
    const canvas = document.getElementById('compare-picture');
    const shown = window.pixels(canvas);
    const isOf = (picture, x) => {
      for (let y = 0; y < canvas.height; ++y) {
        for (let c = 0; c < 3; ++c) {
          const at = 4 * (y * canvas.width + x) + c;
          if (shown[at] !== picture[at]) return false;
        }
      }
      return true;
    };
    const columns = { width: canvas.width, onlyA: [], onlyB: [], neither: [] };
    for (let x = 0; x < canvas.width; ++x) {
      const [a, b] = window.pair.map((picture) => isOf(picture, x));
      if (a && !b) columns.onlyA.push(x);
      if (b && !a) columns.onlyB.push(x);
      if (!a && !b) columns.neither.push(x);
    }
    return columns;
  });
}

// Holds the canvas to A on the left and B on the right of a divider at `share` of the width.
async function expectSplit(page, share) {
  const { width, onlyA, onlyB, neither } = await columnsOnShow(page);
  assert.deepEqual(neither, []);
  assert.ok(onlyA.every((x) => x < share * width) && onlyB.every((x) => x + 1 > share * width), `divided at ${share}`);
  assert.ok(onlyA.length + onlyB.length > width / 4, 'the pictures can be told apart');
  const box = await page.locator('#divider').boundingBox();
  assert.ok(Math.abs(box.x + box.width / 2 - share * page.viewportSize().width) < 1, 'the divider stands there');
  return { onlyA, onlyB };
}

test('the page offers the methods of the server\'s schema, and draws by the one that is chosen', async () => {
  await onPage({ server, settings: kTiny, path: kQuickScene }, async ({ page }) => {
    const { properties } = (await (await page.request.get(`${server.url}/v1/schema/scene.json`)).json()).$defs.render;
    await openPanel(page, 'method');
    for (const key of ['algorithm', 'shading']) {
      const offered = await page.$$eval(`#method-${key} option`, (options) => options.map(({ value }) => value));
      assert.deepEqual(offered, properties[key].enum);
      assert.equal(await page.inputValue(`#method-${key}`), properties[key].default);
    }
    const views = [];
    page.on('request', (request) => request.method() === 'PUT' && views.push(request.postDataJSON()));
    const traced = await look(page);
    await afterMoving(page, () => page.selectOption('#method-algorithm', 'zbuffer'));
    assert.notEqual(await look(page), traced);
    assert.deepEqual(views.at(-1).render, { algorithm: 'zbuffer' });
    assert.equal(new URL(page.url()).hash, '#scene=cubes&algorithm=zbuffer');
    await page.focus('#picture');
    await afterMoving(page, () => page.keyboard.press('Shift+ArrowLeft'));
    assert.ok(views.every(({ render }) => render.algorithm === 'zbuffer'), 'also while it moves');
    await page.keyboard.press('r');
    await page.selectOption('#method-algorithm', 'raytrace');
    await page.waitForFunction((old) => window.lookAt(document.getElementById('picture')) === old, traced);
    assert.equal(new URL(page.url()).hash, '#scene=cubes', 'the scene\'s own method is no wish');
  });
});

test('a method goes along in the link, the curl command and the download', async () => {
  const settings = { ...kTiny, permissions: ['clipboard-read', 'clipboard-write'] };
  await onPage({ server, settings, path: `${kQuickScene}&algorithm=warnock&shading=flat` }, async ({ page, context }) => {
    const clipboard = async (button) => {
      await page.evaluate(() => navigator.clipboard.writeText(''));
      await page.click(button);
      await page.waitForFunction(async () => (await navigator.clipboard.readText()) !== '');
      return page.evaluate(() => navigator.clipboard.readText());
    };
    assert.equal(await page.inputValue('#method-algorithm'), 'warnock');
    const { render } = JSON.parse((await clipboard('#curl-button')).split('\n').at(-3));
    assert.deepEqual(render, { samples: 16, algorithm: 'warnock', shading: 'flat' });
    const [download] = await Promise.all([page.waitForEvent('download'), page.click('#download-button')]);
    assert.equal(await lookOfPng(page, await readFile(await download.path())), await look(page));
    const other = await context.newPage();
    await other.goto(await clipboard('#link-button'));
    await finished(other);
    assert.equal(await other.inputValue('#method-algorithm'), 'warnock');
    assert.equal(await other.inputValue('#method-shading'), 'flat');
  });
});

test('who writes a method into the scene gets it, whatever was chosen before', async () => {
  await onPage({ server, settings: { viewport: { width: 800, height: 480 } }, path: `${kBall}&algorithm=warnock&shading=flat` }, async ({ page }) => {
    await openPanel(page, 'edit');
    const text = await page.inputValue('#editor-text');
    await page.fill('#editor-text', text.replace('"samples":4', '"samples":4,"algorithm":"zbuffer"'));
    await page.waitForFunction(() => document.getElementById('method-algorithm').value === 'zbuffer');
    assert.equal(await page.inputValue('#method-shading'), 'flat', 'what was not written stays as chosen');
    assert.match(page.url(), /&shading=flat$/);
    assert.doesNotMatch(page.url(), /algorithm=/);
  });
});

test('a word in a link that the server does not know is left out', async () => {
  await onPage({ server, settings: kTiny, path: `${kQuickScene}&algorithm=painter&shading=flat` }, async ({ page }) => {
    assert.equal(await page.inputValue('#method-algorithm'), 'raytrace');
    assert.equal(await page.inputValue('#method-shading'), 'flat');
  });
});

test('the divider parts the two pictures where pointer and keys put it', async () => {
  await onPage({ server, settings: { viewport: { width: 800, height: 480 } }, path: kQuickScene }, async ({ page }) => {
    const bodies = sentRenders(page);
    await startComparing(page);
    await page.keyboard.press('Escape');
    assert.equal(bodies.length, 2);
    assert.deepEqual(bodies.map(({ render: { algorithm, shading } }) => ({ algorithm, shading })), kDefaults);
    assert.deepEqual({ ...bodies[0], render: { ...bodies[0].render, ...kDefaults[1] } }, bodies[1], 'one scene, one view, as many samples');
    assert.equal(bodies[0].render.samples, 16);
    await fetchPair(page, bodies);
    const { onlyA, onlyB } = await expectSplit(page, 0.5);
    assert.ok(onlyA.length > 0 && onlyB.length > 0);
    await shoot(page, 'small-compare');

    const { x, y, width } = await page.locator('#divider').boundingBox();
    await page.mouse.move(x + width / 2 + 5, y + 300);
    await page.mouse.down();
    await page.mouse.move(205, 320, { steps: 5 });
    await expectSplit(page, 0.25);
    await page.mouse.up();
    await page.mouse.move(600, 320);
    await expectSplit(page, 0.25);

    const divider = page.locator('#divider');
    const share = async (...keys) => {
      for (const key of keys) await page.keyboard.press(key);
      return Number(await divider.getAttribute('aria-valuenow'));
    };
    await divider.focus();
    assert.equal(await share('ArrowRight', 'ArrowRight', 'ArrowLeft'), 26);
    await expectSplit(page, 0.26);
    assert.equal(await share('PageUp', 'Shift+ArrowRight'), 46);
    assert.match(await divider.getAttribute('aria-valuetext'), /^46 %: A, Ray tracing, Phong, to the left; B, Z-buffer, Gouraud, to the right$/);
    assert.equal(await share('Home'), 0);
    assert.deepEqual((await expectSplit(page, 0)).onlyA, []);
    assert.equal(await share('End'), 100);
    assert.deepEqual((await expectSplit(page, 1)).onlyB, []);
  });
});

test('a finger drags the divider, and beside it turns the camera', async () => {
  await onPage({ server, settings: { ...kPhone, deviceScaleFactor: 1 }, path: kQuickScene }, async ({ page, context }) => {
    await startComparing(page);
    await page.keyboard.press('Escape');
    const touch = await context.newCDPSession(page);
    const swipe = async (from, to, y) => {
      const send = (type, ...points) => touch.send('Input.dispatchTouchEvent', { type, touchPoints: points.map((x) => ({ x, y, id: 0 })) });
      await send('touchStart', from);
      for (let i = 1; i <= 6; ++i) await send('touchMove', from + ((to - from) * i) / 6);
      await send('touchEnd');
    };
    const views = [];
    page.on('request', (request) => request.method() === 'PUT' && views.push(request.postDataJSON()));
    await swipe(180, 90, 370);
    assert.equal(await page.getAttribute('#divider', 'aria-valuenow'), '25');
    assert.equal(views.length, 0);
    await afterMoving(page, () => swipe(250, 300, 370));
    assert.ok(views.length > 0);
    assert.equal(await page.getAttribute('#divider', 'aria-valuenow'), '25');
  });
});

test('the numbers are those of the two pictures, and the difference is drawn as bright as is asked', async () => {
  await onPage({ server, settings: kTiny, path: kQuickScene }, async ({ page }) => {
    const bodies = sentRenders(page);
    const jobs = [];
    page.on('response', async (response) => {
      const isJob = /\/v1\/renders\/\w+$/.test(response.url()) && response.request().method() === 'GET';
      if (isJob) jobs.push(await response.json().catch(() => ({})));
    });
    await startComparing(page);
    await fetchPair(page, bodies);
    const counted = await page.evaluate(() => {
      const [a, b] = window.pair;
      let [differing, squares, largest] = [0, 0, 0];
      for (let i = 0; i < a.length; i += 4) {
        const steps = [0, 1, 2].map((c) => Math.abs(a[i + c] - b[i + c]));
        if (steps.some((step) => step > 0)) ++differing;
        for (const step of steps) {
          squares += (step / 255) ** 2;
          largest = Math.max(largest, step);
        }
      }
      return { differing, rms: Math.sqrt(squares / (a.length / 4) / 3), largest };
    });
    assert.ok(counted.differing > 0);
    assert.equal(await page.textContent('#compare-pixels'), `${counted.differing.toLocaleString('en')} pixels`);
    assert.equal(Number(await page.textContent('#compare-rms')), Number(counted.rms.toPrecision(2)));
    assert.equal(Number(await page.textContent('#compare-largest')), Number((counted.largest / 255).toPrecision(2)));

    const points = jobs.filter(({ state }) => state === 'done').map(({ report }) => report.points.at(-1));
    const rows = await page.$$eval('#compare-rows tr', (trs) => trs.map((tr) => [...tr.cells].slice(1).map((cell) => cell.textContent)));
    assert.equal(points.length, 2);
    const words = (n) => n.toLocaleString('en');
    assert.deepEqual(rows[1].slice(0, 2), points.map(({ rays }) => words(rays.primary)));
    assert.deepEqual(rows[2].slice(0, 2), points.map(({ rays }) => words(rays.shadow)));
    assert.deepEqual(rows[3].slice(0, 2), points.map(({ rays }) => words(rays.reflected + rays.refracted)));
    assert.ok(points[0].rays.reflected > 0 && points[1].rays.reflected === 0, 'a z-buffer knows no mirrors');
    const ratio = points[1].elapsed_ms / points[0].elapsed_ms;
    assert.equal(rows[0][2], `× ${Number(ratio.toPrecision(2))}`);

    await page.click('.segments label:has([value=difference])');
    for (const gain of [1, 4, 16]) {
      await page.click(`.segments label:has([name=compare-gain][value="${gain}"])`);
      const wrong = await page.evaluate((times) => {
        const [a, b] = window.pair;
        return window.pixels(document.getElementById('compare-picture'))
          .filter((value, i) => value !== (i % 4 === 3 ? 255 : Math.min(255, times * Math.abs(a[i] - b[i])))).length;
      }, gain);
      assert.equal(wrong, 0, `brightened ${gain} times`);
    }
    assert.equal(await page.isVisible('#divider'), false);
    await shoot(page, 'small-difference');
  });
});

test('a method is nowhere apart from itself, Warnock nowhere from the z-buffer, and flat is not Phong', async () => {
  await onPage({ server, settings: kTiny, path: kBall }, async ({ page }) => {
    await startComparing(page);
    const differing = () => page.textContent('#compare-pixels');
    for (const [a, b, isSame] of [
      [{ algorithm: 'raytrace', shading: 'phong' }, { algorithm: 'raytrace', shading: 'phong' }, true],
      [{ algorithm: 'zbuffer', shading: 'phong' }, { algorithm: 'warnock', shading: 'phong' }, true],
      [{ algorithm: 'zbuffer', shading: 'gouraud' }, { algorithm: 'warnock', shading: 'gouraud' }, true],
      [{ algorithm: 'raytrace', shading: 'flat' }, { algorithm: 'raytrace', shading: 'phong' }, false],
      [{ algorithm: 'zbuffer', shading: 'flat' }, { algorithm: 'zbuffer', shading: 'phong' }, false],
    ]) {
      await choose(page, 'a', a);
      await choose(page, 'b', b);
      const what = `${JSON.stringify(a)} and ${JSON.stringify(b)}`;
      if (isSame) assert.equal(await differing(), '0 pixels', what);
      else assert.ok(parseInt(await differing(), 10) > 0, what);
    }
  });
});

test('the comparison follows the camera and the scene, and is out of sight while they move', async () => {
  await onPage({ server, settings: { viewport: { width: 800, height: 480 } }, path: kBall }, async ({ page }) => {
    const bodies = sentRenders(page);
    await page.focus('#picture');
    await page.keyboard.press('c');
    await compared(page);
    const first = bodies.length;
    const isWaiting = () => page.evaluate(() => document.getElementById('compare').classList.contains('is-waiting'));
    await page.evaluate(() => {
      window.wasOut = false;
      new MutationObserver(() => { window.wasOut ||= document.getElementById('compare').classList.contains('is-waiting'); })
        .observe(document.getElementById('compare'), { attributes: true });
    });
    await afterMoving(page, () => page.keyboard.press('Shift+ArrowUp'));
    await compared(page);
    assert.ok(await page.evaluate(() => window.wasOut));
    assert.equal(await isWaiting(), false);
    assert.deepEqual(bodies.at(-1).camera, bodies.at(-2).camera);
    assert.notDeepEqual(bodies.at(-1).camera, bodies[first - 1].camera);

    await openPanel(page, 'edit');
    const text = await page.inputValue('#editor-text');
    const { scene } = bodies.at(-1);
    await page.fill('#editor-text', text.replace('0.5', '0.25'));
    const isNew = (body) => body.scene !== scene;
    while (bodies.filter(isNew).length < 2) await page.waitForRequest(isRender);
    await compared(page);
    assert.equal(bodies.at(-1).scene, bodies.at(-2).scene);

    await page.focus('#picture');
    await page.keyboard.press('c');
    assert.equal(await page.isVisible('#compare'), false);
    const asked = bodies.length;
    await afterMoving(page, () => page.keyboard.press('r'));
    assert.equal(bodies.length, asked, 'switched off it costs nothing');
  });
});

test('a side that the server refuses says why in its place, and the other is drawn', async () => {
  await onPage({ server, settings: kTiny, path: kBall, expected: [/422/] }, async ({ page }) => {
    await page.route('**/v1/renders', (route) => (route.request().postDataJSON().render.algorithm !== 'zbuffer' ? route.continue() : route.fulfill({
      status: 422, contentType: 'application/problem+json', body: '{"title": "Not valid", "detail": "too many triangles"}',
    })));
    await openPanel(page, 'method');
    await page.check('#compare-toggle');
    await page.waitForSelector('#compare-error-b:has-text("too many triangles")');
    assert.equal(await page.textContent('#compare-error-a'), '');
    assert.equal(await page.textContent('#compare-tag-b .tag-word'), 'not drawn');
    assert.equal(await page.textContent('#compare-state'), 'There is nothing to compare.');
    await choose(page, 'b', { algorithm: 'raytrace', shading: 'gouraud' });
    assert.equal(await page.textContent('#compare-error-b'), '');
  });
});

test('a busy server is waited for, and that is said', async () => {
  await onPage({ server, settings: kTiny, path: kBall, expected: [/503/] }, async ({ page }) => {
    await page.route('**/v1/renders', (route) => route.fulfill({
      status: 503, headers: { 'Retry-After': '1' }, contentType: 'application/problem+json', body: '{"title": "busy"}',
    }), { times: 1 });
    await openPanel(page, 'method');
    await page.check('#compare-toggle');
    await page.waitForSelector('#compare-state:has-text("busy")');
    await compared(page);
  });
});

test('a comparison leaves no jobs behind', async () => {
  await onPage({ server, settings: kTiny, path: kBall }, async ({ page }) => {
    const jobs = [];
    const deleted = new Set();
    page.on('response', (response) => {
      if (isRender(response.request())) jobs.push(server.url + response.headers().location);
      if (response.request().method() === 'DELETE') deleted.add(response.url());
    });
    await startComparing(page);
    assert.equal(jobs.length, 2);
    while (!jobs.every((job) => deleted.has(job))) await page.waitForResponse((response) => response.request().method() === 'DELETE');
    for (const job of jobs) assert.equal((await page.request.get(job)).status(), 404);
  });
});

test('of the error by pixel and the comparison only one lies over the picture', async () => {
  await onPage({ server, settings: kTiny, path: kBall }, async ({ page }) => {
    await page.focus('#picture');
    await page.keyboard.press('h');
    await page.keyboard.press('c');
    assert.ok(await page.isVisible('#compare'));
    assert.equal(await page.isVisible('#heat-legend'), false);
    await page.keyboard.press('h');
    assert.equal(await page.isVisible('#compare'), false);
    assert.ok(await page.isVisible('#heat-legend'));
  });
});

test('a line drawing can be had as lines, and nothing else can', async () => {
  await onPage({ server, settings: kTiny, path: kBall }, async ({ page }) => {
    const lines = '<svg xmlns="http://www.w3.org/2000/svg"/>';
    await page.route('**/v1/renders/*/image', (route) => (route.request().headers().accept !== 'image/svg+xml' ? route.continue()
      : route.fulfill({ contentType: 'image/svg+xml', body: lines })));
    await openPanel(page, 'method');
    assert.equal(await page.isVisible('#lines-button'), false);
    await page.selectOption('#method-algorithm', 'roberts');
    const [download] = await Promise.all([page.waitForEvent('download'), page.click('#lines-button')]);
    assert.equal(download.suggestedFilename(), 'tilelight-shared-scene-480x320.svg');
    assert.equal(await readFile(await download.path(), 'utf8'), lines);
    await page.selectOption('#method-algorithm', 'zbuffer');
    assert.equal(await page.isVisible('#lines-button'), false);
  });
});

for (const [name, settings] of [['desktop', { viewport: { width: 1280, height: 800 } }],
  ['phone', { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true }]]) {
  test(`a comparison fits on a ${name}`, async () => {
    await onPage({ server, settings: { ...settings, colorScheme: 'dark' }, path: kQuickScene }, async ({ page }) => {
      await startComparing(page);
      const fits = async (what) => {
        const sticking = await page.evaluate(() => [...document.querySelectorAll('#method-panel *, .bar *, #compare *')]
          .filter((e) => e.checkVisibility({ visibilityProperty: true }) && !e.closest('.for-readers, .label'))
          .map((e) => [e.id || e.className || e.tagName, e.getBoundingClientRect()])
          .filter(([, box]) => box.width > 0 && (box.left < -0.5 || box.right > innerWidth + 0.5)).map(([id]) => String(id)));
        assert.deepEqual(sticking, [], what);
        assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth
          && document.querySelector('#method-panel .panel-body').scrollWidth <= document.querySelector('#method-panel .panel-body').clientWidth), what);
        await shoot(page, `${name}-compare-${what}`);
      };
      await fits('divider');
      await page.locator('.segments label:has([value=difference])').click();
      await page.locator('#compare-rows').scrollIntoViewIfNeeded();
      await fits('difference');
      const bar = await page.evaluate(() => ['.bar-brand', '.bar-tools'].map((bar) => document.querySelector(bar).getBoundingClientRect().toJSON()));
      assert.ok(bar[0].right <= bar[1].left || bar[0].bottom <= bar[1].top, 'the bars do not touch');
    });
  });
}
