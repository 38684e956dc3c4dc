// SPDX-License-Identifier: Apache-2.0
// Panels and commands around the picture: scenes, editor, plan, and the ways to take a picture along.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtemp, readFile, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { promisify } from 'node:util';
import { afterMoving, finished, kDesktop, kPhone, kQuickScene, kSmall, look, lookOfPng, onPage, openPanel, shoot, startServer } from './harness.mjs';

const run = promisify(execFile);
const kPngSignature = '89504e470d0a1a0a';
const kRefused = [/422/, /400/];  // the browser logs every refused request; here they are asked for

let server;
before(async () => { server = await startServer(); });
after(() => server.stop());

function pngSize(bytes) {
  assert.equal(bytes.subarray(0, 8).toString('hex'), kPngSignature);
  return { width: bytes.readUInt32BE(16), height: bytes.readUInt32BE(20) };
}

// Puts the caret behind `text` in the editor, as a click would, so that what follows is typed there.
async function caretAfter(page, text) {
  await page.focus('#editor-text');
  await page.evaluate((needle) => {
    const area = document.getElementById('editor-text');
    const at = area.value.indexOf(needle) + needle.length;
    area.setSelectionRange(at, at);
  }, text);
}

test('every scene of the picker has a title, a small picture, and can be shown', async () => {
  await onPage({ server }, async ({ page }) => {
    const titles = new Set();
    await openPanel(page, 'scenes');
    const count = await page.locator('.scene').count();
    assert.ok(count >= 8);
    await page.waitForFunction((n) => document.querySelectorAll('.scene-thumb img').length === n, count);
    await shoot(page, 'small-scenes');
    for (let i = 1; i <= count; ++i) {
      await afterMoving(page, () => page.click(`li:nth-child(${i % count + 1}) > .scene`));
      titles.add(await page.textContent('#scene-title'));
      assert.equal(await page.locator('.scene[aria-current]').count(), 1);
    }
    assert.equal(titles.size, count);
  });
});

test('a scene can be picked by keyboard alone, and Escape gives the focus back', async () => {
  await onPage({ server, path: kQuickScene }, async ({ page }) => {
    await page.focus('#scenes-button');
    await page.keyboard.press('Enter');
    await page.keyboard.press('Tab');
    await page.keyboard.press('Tab');
    await page.keyboard.press('Tab');
    await afterMoving(page, () => page.keyboard.press('Enter'));
    assert.equal(await page.textContent('#scene-title'), 'Endgame');
    await page.keyboard.press('Escape');
    assert.equal(await page.evaluate(() => document.activeElement.id), 'scenes-button');
    assert.equal(await page.isVisible('#scenes-panel'), false);
  });
});

test('a FEN that is typed is drawn, and the rest of the text is left alone', async () => {
  await onPage({ server }, async ({ page }) => {
    await openPanel(page, 'edit');
    const before = await page.inputValue('#editor-text');
    const fen = await page.inputValue('#fen');
    const other = 'rnbqkbnr/pp1ppppp/8/2p5/4P3/5N2/PPPP1PPP/RNBQKB1R b KQkq - 1 2';
    await afterMoving(page, () => page.fill('#fen', other));
    assert.equal(await page.inputValue('#editor-text'), before.replace(fen, other));
    assert.equal(await page.textContent('#fen-error'), '');
    assert.match(await page.textContent('#scene-title'), /edited/);
  });
});

test('a FEN that is no position says so in its place, and the picture stays', async () => {
  await onPage({ server, expected: kRefused }, async ({ page }) => {
    await openPanel(page, 'edit');
    const before = await look(page);
    await page.fill('#fen', 'rnbqkbnr/pppppppp/9/8/8/8/PPPPPPPP/RNBQKBNR w - - 0 1');
    await page.waitForFunction(() => document.getElementById('fen-error').textContent !== '');
    assert.equal(await page.getAttribute('#fen', 'aria-invalid'), 'true');
    assert.equal(await look(page), before);
    await shoot(page, 'small-fen-error');
    assert.equal(await page.locator('.dot').count(), 1, 'its line is marked');
    assert.equal(await page.locator('.error').count(), 0, 'its words stand in one place');
    await page.fill('#fen', '8/8/8/4k3/8/4K3/4P3/8 w - - 0 1');
    await page.waitForFunction(() => document.getElementById('fen-error').textContent === '');
    assert.equal(await page.getAttribute('#fen', 'aria-invalid'), 'false');
  });
});

test('a mistake in the scene is marked on its line, explained, and a click leads to it', async () => {
  await onPage({ server, expected: kRefused }, async ({ page }) => {
    await openPanel(page, 'edit');
    await caretAfter(page, '"type": "plane", ');
    await page.keyboard.insertText('"colour": 3, ');
    await page.waitForSelector('.error');
    const text = await page.inputValue('#editor-text');
    const line = text.slice(0, text.indexOf('"colour"')).split('\n').length;
    assert.match(await page.textContent('.error-place'), new RegExp(`^Line ${line}\\b`));
    assert.match(await page.textContent('.error-place'), /\/objects\/1\/colour/);
    const marked = await page.evaluate(() => document.querySelector('.mark-line').style.getPropertyValue('--line'));
    assert.equal(Number(marked) + 1, line);
    assert.equal(await page.locator('.dot').count(), await page.locator('.error').count());
    await page.click('.error');
    const selected = await page.evaluate(() => {
      const area = document.getElementById('editor-text');
      return area.value.slice(area.selectionStart, area.selectionEnd);
    });
    assert.match(selected, /^("colour"|3)$/);
    await shoot(page, 'small-editor-error');
  });
});

test('a misspelt name comes with the right one', async () => {
  await onPage({ server, path: kQuickScene, expected: kRefused }, async ({ page }) => {
    await openPanel(page, 'edit');
    await page.fill('#editor-text', '{"tilelight": 1, "objects": [{"type": "sphere", "raduis": 2}]}');
    await page.waitForSelector('.error');
    assert.match(await page.textContent('.error'), /radius/);
  });
});

test('text that is not JSON is marked where it breaks', async () => {
  await onPage({ server, path: kQuickScene, expected: kRefused }, async ({ page }) => {
    await openPanel(page, 'edit');
    await page.fill('#editor-text', '{\n  "tilelight": 1,\n  "objects": [,]\n}\n');
    await page.waitForSelector('.error');
    assert.match(await page.textContent('.error-place'), /^Line 3/);
    assert.equal(await page.textContent('#editor-state'), '1 mistake');
  });
});

test('an edit keeps the camera where the hand left it', async () => {
  await onPage({ server, path: kQuickScene }, async ({ page }) => {
    const positions = [];
    page.on('request', (request) => request.method() === 'PUT' && positions.push(request.postDataJSON().camera.position));
    await page.focus('#picture');
    await afterMoving(page, () => page.keyboard.press('Shift+ArrowLeft'));
    const moved = positions.at(-1);
    await openPanel(page, 'edit');
    await caretAfter(page, '"ambient": 0.16');
    await afterMoving(page, () => page.keyboard.insertText('9'));
    assert.deepEqual(positions.at(-1), moved);
  });
});

test('an edit made without the server is no mistake, and is drawn when the server is back', async () => {
  await onPage({ server, path: kQuickScene, expected: [/ERR_INTERNET_DISCONNECTED/] }, async ({ page, context }) => {
    await openPanel(page, 'edit');
    await context.setOffline(true);
    await caretAfter(page, '"ambient": 0.16');
    await page.keyboard.insertText('9');
    await page.waitForSelector('#notice:has-text("cannot be reached")');
    assert.equal(await page.locator('.error').count(), 0);
    await afterMoving(page, () => context.setOffline(false));
    assert.match(await page.textContent('#scene-title'), /edited/);
    assert.equal(await page.isVisible('#notice'), false);
  });
});

test('an edit that the busy server turns away is tried again when it said', async () => {
  await onPage({ server, path: kQuickScene, expected: [/503/] }, async ({ page }) => {
    await openPanel(page, 'edit');
    await page.route('**/v1/sessions', (route) => route.fulfill({
      status: 503, headers: { 'Retry-After': '1' }, contentType: 'application/problem+json', body: '{"title": "busy"}',
    }), { times: 1 });
    await caretAfter(page, '"ambient": 0.16');
    await afterMoving(page, async () => {
      await page.keyboard.insertText('9');
      await page.waitForSelector('#notice:has-text("busy")');
      assert.equal(await page.locator('.error').count(), 0);
    });
    assert.equal(await page.isVisible('#notice'), false);
  });
});

test('a FEN goes into a text with mistakes, and the text is kept', async () => {
  await onPage({ server, settings: { viewport: { width: 480, height: 640 } }, expected: kRefused }, async ({ page }) => {
    await openPanel(page, 'edit');
    const fen = await page.inputValue('#fen');
    const other = '8/8/8/4k3/8/4K3/4P3/8 w - - 0 1';
    await caretAfter(page, '"type": "plane", ');
    await page.keyboard.insertText('"colour": 3, ');
    await page.waitForSelector('.error');
    const draft = await page.inputValue('#editor-text');
    await Promise.all([
      page.waitForResponse((response) => response.url().endsWith('/v1/sessions')),
      page.fill('#fen', other),
    ]);
    assert.equal(await page.inputValue('#editor-text'), draft.replace(fen, other));
    assert.equal(await page.getAttribute('#fen', 'aria-invalid'), 'false');
    await afterMoving(page, () => page.fill('#editor-text', draft.replace(fen, other).replace('"colour": 3, ', '')));
    assert.equal(await page.inputValue('#fen'), other);
    assert.equal(await page.locator('.error').count(), 0);
  });
});

test('the plan says what is in use and what was left out and why', async () => {
  await onPage({ server, path: kQuickScene }, async ({ page }) => {
    await openPanel(page, 'plan');
    assert.ok(await page.locator('.chips li').count() > 0);
    assert.ok(await page.locator('.left-out dt').count() > 0);
    assert.equal(await page.locator('.left-out dt').count(), await page.locator('.left-out dd').count());
    assert.match(await page.textContent('#plan-body'), /Triangles/);
    await page.waitForSelector('.predicted dt');
    assert.match(await page.textContent('.this-picture'), /Predicted.*rays.*Rendering/);
    await shoot(page, 'small-plan');
  });
});

test('the download is the very picture on the screen', async () => {
  await onPage({ server, path: kQuickScene }, async ({ page }) => {
    await page.focus('#picture');
    await afterMoving(page, () => page.keyboard.press('Shift+ArrowRight'));
    const [download] = await Promise.all([page.waitForEvent('download'), page.click('#download-button')]);
    assert.equal(download.suggestedFilename(), 'tilelight-cubes-768x480.png');
    const bytes = await readFile(await download.path());
    assert.deepEqual(pngSize(bytes), kSmall.viewport);
    assert.equal(await lookOfPng(page, bytes), await look(page));
  });
});

test('the copied curl command runs and gives the picture on the screen', async () => {
  const settings = { ...kSmall, permissions: ['clipboard-read', 'clipboard-write'] };
  await onPage({ server, settings, path: kQuickScene }, async ({ page }) => {
    await page.click('#curl-button');
    await page.waitForSelector('.toast.is-shown:has-text("copied")');
    const command = await page.evaluate(() => navigator.clipboard.readText());
    const folder = await mkdtemp(path.join(tmpdir(), 'tilelight-curl-'));
    try {
      await run('sh', ['-c', command], { cwd: folder });
      const bytes = await readFile(path.join(folder, 'tilelight.png'));
      assert.deepEqual(pngSize(bytes), kSmall.viewport);
      assert.equal(await lookOfPng(page, bytes), await look(page));
    } finally {
      await rm(folder, { recursive: true });
    }
  });
});

test('a link leads back to the same scene from the same place', async () => {
  const settings = { ...kSmall, permissions: ['clipboard-read', 'clipboard-write'] };
  await onPage({ server, settings, path: '/#scene=knight' }, async ({ page, context }) => {
    assert.equal(await page.textContent('#scene-title'), 'Knight');
    await page.focus('#picture');
    await afterMoving(page, () => page.keyboard.press('Shift+ArrowRight'));
    await page.click('#link-button');
    await page.waitForSelector('.toast.is-shown:has-text("copied")');
    const url = await page.evaluate(() => navigator.clipboard.readText());
    const other = await context.newPage();
    await other.goto(url);
    await finished(other);
    assert.equal(await other.textContent('#scene-title'), 'Knight');
  });
});

test('a link put into an open page is followed', async () => {
  await onPage({ server, path: kQuickScene }, async ({ page }) => {
    const views = [];
    page.on('request', (request) => request.method() === 'PUT' && views.push(request.postDataJSON().camera));
    await afterMoving(page, () => page.evaluate(() => { location.hash = '#scene=cubes&camera=p,33,9,4,2,0,1,0,0,1,0'; }));
    assert.deepEqual(views.at(-1).position, [9, 4, 2]);
    await page.evaluate(() => { location.hash = '#scene=knight'; });
    await page.waitForSelector('#scene-title:has-text("Knight")');
  });
});

for (const [what, hash, words] of [
  ['a damaged text', 'json=AAAA', /damaged/],
  ['an unknown scene', 'scene=nowhere', /no scene “nowhere”/],
]) {
  test(`a link to ${what} says so, and the first scene comes from its own place`, async () => {
    await onPage({ server, path: kQuickScene }, async ({ page }) => {
      const { camera } = await (await page.request.get(`${server.url}/scenes/opening.json`)).json();
      const [view] = await Promise.all([
        page.waitForRequest((request) => request.method() === 'PUT'),
        page.evaluate((at) => { location.hash = `#${at}&camera=p,33,9,4,2,0,1,0,0,1,0`; }, hash),
      ]);
      assert.match(await page.textContent('.toast.is-shown'), words);
      assert.equal(await page.textContent('#scene-title'), 'Opening');
      assert.deepEqual(view.postDataJSON().camera.position, camera.position);
    });
  });
}

test('before there is a picture nothing can be taken along', async () => {
  const buttons = ['reset', 'link', 'curl', 'download'];
  await onPage({ server, path: kQuickScene, expected: [/422/] }, async ({ page, context }) => {
    for (const name of buttons) assert.ok(await page.isEnabled(`#${name}-button`), name);
    const other = await context.newPage();
    await other.route('**/scenes/cubes.json', (route) => route.fulfill({ body: '{"objects": 3}' }));
    await other.goto(server.url + kQuickScene);
    await other.waitForSelector('#notice-button');
    for (const name of buttons) assert.ok(await other.isDisabled(`#${name}-button`), name);
    await other.unroute('**/scenes/cubes.json');
    await other.click('#notice-button');
    await finished(other);
    for (const name of buttons) assert.ok(await other.isEnabled(`#${name}-button`), name);
  });
});

test('clicks while a picture is being made start no second render', async () => {
  await onPage({ server, path: kQuickScene }, async ({ page }) => {
    let asked = 0;
    await page.route('**/v1/renders', async (route) => {
      ++asked;
      await route.continue();
    });
    const [download] = await Promise.all([
      page.waitForEvent('download'),
      page.evaluate(() => { for (let i = 0; i < 3; ++i) document.getElementById('download-button').click(); }),
    ]);
    await download.path();
    assert.equal(asked, 1);
  });
});

test('in a low window the editor stays within its panel, which scrolls', async () => {
  await onPage({ server, settings: { viewport: { width: 640, height: 360 } }, path: '/#scene=endgame&samples=1' }, async ({ page }) => {
    await openPanel(page, 'edit');
    await page.locator('#editor-text').scrollIntoViewIfNeeded();
    const [panel, editor] = await page.evaluate(() => ['edit-panel', 'editor']
      .map((id) => document.getElementById(id).getBoundingClientRect().bottom));
    assert.ok(editor <= panel + 0.5, `${editor} is below ${panel}`);
    await page.click('#editor-text');
    await shoot(page, 'low-edit');
  });
});

for (const [name, settings] of [['phone', kPhone], ['tablet', { viewport: { width: 768, height: 1024 } }],
  ['desktop', kDesktop]]) {
  test(`nothing sticks out of a ${name}, with any panel open`, async () => {
    await onPage({ server, settings: { ...settings, colorScheme: 'dark' } }, async ({ page }) => {
      const { width } = settings.viewport;
      const check = async (what) => {
        const out = await page.evaluate((limit) => [...document.querySelectorAll('body *')]
          .filter((e) => e.checkVisibility({ visibilityProperty: true }) && !e.closest('.editor, .for-readers, .cover'))
          .map((e) => [e.id || e.className || e.tagName, e.getBoundingClientRect()])
          .filter(([, box]) => box.width > 0 && (box.left < -0.5 || box.right > limit + 0.5))
          .map(([id]) => String(id)), width);
        assert.deepEqual(out, [], what);
        assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), what);
        await shoot(page, `${name}-${what}`);
      };
      await check('closed');
      for (const panel of ['scenes', 'edit', 'plan', 'error', 'method']) {
        await openPanel(page, panel);
        await check(panel);
        await page.keyboard.press('Escape');
      }
    });
  });
}
