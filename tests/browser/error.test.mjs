// SPDX-License-Identifier: Apache-2.0
// The error of the picture on the page: its curve, its map by pixel, and the rules that end a picture.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { afterMoving, finished, kPhone, kQuickScene, kSmall, look, lookOfPng, onPage, openPanel, shoot, startServer } from './harness.mjs';

let server;
before(async () => { server = await startServer(); });
after(() => server.stop());

const kTiny = { viewport: { width: 480, height: 320 } };
const isPut = (request) => request.method() === 'PUT';
const rmseOf = (header) => Number(/rmse=([\d.]+)/.exec(header)?.[1] ?? NaN);

// The scene that is on show under the page's last view, rendered apart from it: its document at the end.
async function renderedApart(page, view) {
  const scene = await (await page.request.get(`${server.url}/scenes/cubes.json`)).json();
  const { camera, image, render } = view;
  const data = { ...scene, camera, image: { ...scene.image, ...image }, render: render ? { rmse: render.rmse } : scene.render };
  const accepted = await page.request.post(`${server.url}/v1/renders`, { data, headers: { Prefer: 'respond-async' } });
  const path = server.url + accepted.headers().location;
  for (;;) {
    const job = await (await page.request.get(path, { headers: { Prefer: 'wait=30' } })).json();
    if (job.state === 'done') return { ...job, path };
    assert.ok(['queued', 'running'].includes(job.state), job.state);
  }
}

// The views that are sent and the frames that come from now on; frames as {viewSeq, info, url}.
function overhear(page) {
  const heard = { views: [], frames: [] };
  page.on('request', (request) => isPut(request) && heard.views.push(request.postDataJSON()));
  page.on('response', (response) => {
    const { 'view-seq': viewSeq, 'render-info': info } = response.headers();
    if (viewSeq) heard.frames.push({ viewSeq: Number(viewSeq), info, url: response.url() });
  });
  return heard;
}

async function chooseRule(page, key) {
  await page.click(`.segments label:has([value=${key}])`);
  await page.waitForSelector('#rule-own:not([hidden])');
}

test('the curve has the passes of the view as the server told them, and as a render apart reports them', async () => {
  await onPage({ server, settings: kTiny, path: kQuickScene }, async ({ page }) => {
    const heard = overhear(page);
    await openPanel(page, 'error');
    await page.focus('#picture');
    await afterMoving(page, () => page.keyboard.press('Shift+ArrowLeft'));
    const told = await page.$$eval('#error-rows tr', (rows) => rows.map((row) => [...row.cells].slice(0, 2).map((cell) => Number(cell.textContent))));
    const { seq } = heard.views.at(-1);
    const passes = new Map(heard.frames.filter(({ viewSeq, info }) => viewSeq === seq && rmseOf(info) > 0)
      .map(({ info }) => [Number(/spp=([\d.]+)/.exec(info)[1]), rmseOf(info)]));
    assert.deepEqual(told, [...passes]);
    assert.ok(told.length >= 1);
    const { report } = await renderedApart(page, heard.views.at(-1));
    for (const [spp, rmse] of told) {
      const point = report.points.find((p) => p.spp === spp);
      assert.equal(rmse, Number(point.rmse.toFixed(6)), `${spp} samples`);
    }
    assert.equal(await page.locator('.plot-point').count(), told.length);
    assert.equal(await page.locator('.plot-point.is-end').count(), 1);
    assert.match(await page.getAttribute('#error-plot', 'aria-label'), new RegExp(`${told.at(-1)[1].toPrecision(2)} after`));
    assert.equal(Number(await page.textContent('#error-now')), Number(told.at(-1)[1].toPrecision(2)));
    assert.equal(await page.textContent('#error-samples'), '16');
    assert.ok(await page.isVisible('#key-before'), 'the view before is there to compare with');
  });
});

test('points stand where the axes say', async () => {
  await onPage({ server, settings: { viewport: { width: 900, height: 900 } }, path: kQuickScene }, async ({ page }) => {
    await openPanel(page, 'error');
    const { ticks, points } = await page.evaluate(() => ({
      ticks: [...document.querySelectorAll('.plot-grid text.is-end:not(.plot-axis)')].map((text) => [Number(text.textContent), Number(text.getAttribute('y')) - 4]),
      points: [...document.querySelectorAll('.plot-point')].map((point) => Number(point.getAttribute('cy'))),
    }));
    const errors = await page.$$eval('#error-rows tr', (rows) => rows.map((row) => Number(row.cells[1].textContent)));
    const [[low, yLow], [high, yHigh]] = [ticks[0], ticks.at(-1)];
    const yOf = (error) => yLow + (yHigh - yLow) * (Math.log(error / low) / Math.log(high / low));
    for (const [tick, y] of ticks) assert.ok(Math.abs(yOf(tick) - y) < 0.2, `tick ${tick}`);
    points.forEach((y, i) => assert.ok(Math.abs(yOf(errors[i]) - y) < 0.2, `error ${errors[i]}`));
    assert.ok(points.length >= 2);
  });
});

test('the error by pixel is the renderer\'s own map, in the size of the picture', async () => {
  await onPage({ server, path: kQuickScene }, async ({ page }) => {
    const heard = overhear(page);
    const isMapped = () => page.waitForSelector('#heat:not([hidden])');
    const map = () => page.evaluate(() => window.lookAt(document.getElementById('heat')));
    await page.focus('#picture');
    await afterMoving(page, () => page.keyboard.press('Shift+ArrowLeft'));
    assert.equal(await page.isVisible('#heat'), false);
    assert.ok(heard.frames.every(({ url }) => !url.includes('layer')), 'switched off it costs nothing');
    await page.keyboard.press('h');
    await isMapped();
    assert.ok(await page.isVisible('#heat-legend'));
    const job = await renderedApart(page, heard.views.at(-1));
    const own = await lookOfPng(page, await (await page.request.get(`${job.path}/image?layer=error`)).body());
    assert.equal(await map(), own);
    assert.match(own, /^768x480:/);
    assert.notEqual(own, await look(page));
    await shoot(page, 'small-heat');

    await page.keyboard.down('Shift');
    await page.keyboard.press('ArrowUp');
    await page.waitForSelector('#heat', { state: 'hidden' });
    await page.keyboard.up('Shift');
    await isMapped();
    await finished(page);
    await page.waitForFunction((old) => window.lookAt(document.getElementById('heat')) !== old, own);
    await page.keyboard.press('h');
    assert.equal(await page.isVisible('#heat'), false);
    assert.equal(await page.isVisible('#heat-legend'), false);
  });
});

test('the map comes back after a session that the server has forgotten', async () => {
  await onPage({ server, settings: kTiny, path: kQuickScene, expected: [/404/, /410/] }, async ({ page }) => {
    await page.focus('#picture');
    const [put] = await Promise.all([page.waitForRequest(isPut), page.keyboard.press('Shift+ArrowLeft')]);
    await finished(page);
    await page.request.delete(put.url().replace(/\/view$/, ''));
    await page.keyboard.press('h');
    await page.waitForSelector('#heat:not([hidden])');
    assert.equal(await page.isVisible('#notice'), false);
  });
});

test('a rule by error ends the picture once its error is as asked, and stays over a reload', async () => {
  await onPage({ server, path: kQuickScene }, async ({ page }) => {
    const heard = overhear(page);
    await openPanel(page, 'error');
    assert.match(await page.textContent('#rule-scene'), /16 samples a pixel/);
    await chooseRule(page, 'rmse');
    await page.click('.chip:has-text("0.01")');
    await page.waitForSelector('#status-main:has-text("Error 0.01 reached")');
    const last = heard.frames.at(-1);
    assert.match(last.info, /stop="rmse"/);
    assert.ok(rmseOf(last.info) <= 0.01, last.info);
    assert.ok(await page.isVisible('#key-asked'));
    assert.equal(await page.locator('.chip[aria-pressed="true"]').textContent(), '0.01');
    await shoot(page, 'small-error');

    await page.reload();
    await finished(page);
    assert.match(await page.textContent('#status-main'), /^Error 0\.01 reached$/);
    assert.equal(await page.isChecked('[name=rule][value=rmse]'), true);
    await openPanel(page, 'error');
    await page.click('.segments label:has([value=scene])');
    await page.waitForSelector('#status-main:has-text("16 samples taken")');
    assert.equal(new URL(page.url()).hash, '#scene=cubes');
  });
});

test('a rule goes along in the link and in the curl command, and the download is the picture on the screen', async () => {
  const settings = { ...kSmall, permissions: ['clipboard-read', 'clipboard-write'] };
  await onPage({ server, settings, path: `${kQuickScene}&rmse=0.01` }, async ({ page, context }) => {
    const clipboard = async (button) => {
      await page.evaluate(() => navigator.clipboard.writeText(''));
      await page.click(button);
      await page.waitForFunction(async () => (await navigator.clipboard.readText()) !== '');
      return page.evaluate(() => navigator.clipboard.readText());
    };
    const link = await clipboard('#link-button');
    const document_ = JSON.parse((await clipboard('#curl-button')).split('\n').at(-3));
    assert.equal(document_.render.rmse, 0.01);
    assert.equal('samples' in document_.render, false);
    const { body } = await page.evaluate(async (data) => {
      const answer = await fetch('/v1/renders', { method: 'POST', body: data, headers: { 'Content-Type': 'application/json', Accept: 'image/png', Prefer: 'wait=60' } });
      return { body: [...new Uint8Array(await answer.arrayBuffer())] };
    }, JSON.stringify(document_));
    assert.equal(await lookOfPng(page, Buffer.from(body)), await look(page));
    const other = await context.newPage();
    await other.goto(link);
    await finished(other);
    assert.match(await other.textContent('#status-main'), /^Error 0\.01 reached$/);
  });
});

test('a rule by time ends the picture in that time', async () => {
  await onPage({ server, settings: kTiny, path: kQuickScene }, async ({ page }) => {
    const heard = overhear(page);
    await openPanel(page, 'error');
    await chooseRule(page, 'time_ms');
    await page.waitForSelector('#status-main:has-text("Time is up: 2 s")', { state: 'attached' });  // hidden behind the panel
    const { info } = heard.frames.at(-1);
    assert.match(info, /stop="time"/);
    const spp = Number(/spp=([\d.]+)/.exec(info)[1]);
    const shown = Number(/([\d.]+) samples?$/.exec(await page.textContent('#status-more'))[1]);
    const rounding = spp < 100 ? 0.05 : 0.5;  // a fast machine comes past a hundred, which are shown whole
    assert.ok(Math.abs(shown - spp) <= rounding + 1e-9, `${shown} is shown for ${spp}`);
  });
});

test('a number that is no rule is explained, and the rule before it holds', async () => {
  await onPage({ server, settings: { ...kPhone, deviceScaleFactor: 1 }, path: kQuickScene }, async ({ page }) => {
    await openPanel(page, 'error');
    await chooseRule(page, 'samples');
    await page.fill('#rule-number', '2');
    await page.keyboard.press('Enter');
    await page.waitForSelector('#status-main:has-text("2 samples taken")', { state: 'attached' });
    const heard = overhear(page);
    await page.fill('#rule-number', '2.5');
    await page.keyboard.press('Enter');
    await page.waitForSelector('#rule-error:not(:empty)');
    assert.equal(await page.textContent('#rule-error'), 'Found “2.5”; allowed: whole numbers from 1 to 4096.');
    assert.equal(await page.getAttribute('#rule-number', 'aria-invalid'), 'true');
    assert.equal(heard.views.length, 0);
    assert.match(page.url(), /samples=2$/);
    await shoot(page, 'phone-rule-error');
  });
});
