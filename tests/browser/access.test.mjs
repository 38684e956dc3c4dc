// SPDX-License-Identifier: Apache-2.0
// The page for everybody: axe-core's rules on every state of the page, names, focus, less motion, and what is spoken.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { after, before, test } from 'node:test';
import { afterMoving, compared, finished, kDesktop, kPhone, kQuickScene, onPage, openPanel, startServer } from './harness.mjs';

const kAxe = await readFile(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

let server;
before(async () => { server = await startServer(); });
after(() => server.stop());

// What axe-core finds by all the rules that are on by default. The panes are made opaque first: axe judges no text over a
// canvas, and would pass over the contrast of all that floats.
async function findViolations(page) {
  await page.addStyleTag({ content: ':root { --pane: var(--pane-solid) !important; } * { backdrop-filter: none !important; }' });
  await page.evaluate(kAxe);
  const { violations, passes } = await page.evaluate(() => window.axe.run(document));
  assert.ok(passes.some(({ id }) => id === 'color-contrast'), 'contrast was judged');
  return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target.join(' ')).join(', ')}`);
}

// The opening, drawn on the phone, has a chess position and so the FEN field; the desktop shows the quicker scene.
for (const [size, settings, where] of [['desktop', kDesktop, kQuickScene], ['phone', kPhone, '/']]) {
  for (const colorScheme of ['light', 'dark']) {
    test(`axe-core finds nothing on a ${size}, ${colorScheme}, whatever is open`, async () => {
      await onPage({
        server, settings: { ...settings, deviceScaleFactor: 1, colorScheme, reducedMotion: 'reduce', bypassCSP: true },
        path: where, expected: [/422/],
      }, async ({ page }) => {
        assert.deepEqual(await findViolations(page), [], 'closed');
        for (const panel of ['scenes', 'edit', 'plan', 'error', 'method']) {
          await openPanel(page, panel);
          assert.deepEqual(await findViolations(page), [], panel);
          if (panel === 'edit' && size === 'phone') {
            await page.fill('#fen', 'rnbqkbnr/pppppppp/9/8/8/8/PPPPPPPP/RNBQKBNR w - - 0 1');
            await page.waitForSelector('#fen[aria-invalid="true"]');
            assert.deepEqual(await findViolations(page), [], 'edit with a FEN that is no position');
          }
          if (panel === 'edit') {
            await page.fill('#editor-text', '{"objects": [{"type": "sphere", "raduis": 2}]}');
            await page.waitForSelector('.error:has-text("radius")');
            assert.deepEqual(await findViolations(page), [], 'edit with a mistake');
          }
          if (panel === 'error') {
            await page.check('#heat-toggle');
            await page.click('.segments label:has([value=rmse])');
            await page.fill('#rule-number', '-1');
            await page.keyboard.press('Enter');
            await page.waitForSelector('#rule-error:not(:empty)');
            assert.deepEqual(await findViolations(page), [], 'error with colours and a number that is none');
          }
          if (panel === 'method') {
            await page.check('#compare-toggle');
            await compared(page);
            assert.deepEqual(await findViolations(page), [], 'two methods side by side');
            await page.click('.segments label:has([value=difference])');
            assert.deepEqual(await findViolations(page), [], 'the difference of two methods');
          }
          await page.keyboard.press('Escape');
        }
      });
    });
  }
}

test('every control has a name and shows the focus', async () => {
  await onPage({ server, path: kQuickScene }, async ({ page }) => {
    const nameless = await page.evaluate(() => [...document.querySelectorAll('button, input, select, textarea, [role=slider], canvas:not([aria-hidden])')]
      .filter((e) => !(e.textContent.trim() || e.getAttribute('aria-label') || e.labels?.length || e.getAttribute('aria-labelledby')))
      .map((e) => e.outerHTML));
    assert.deepEqual(nameless, []);
    const seen = [];
    for (let i = 0; i < 10; ++i) {
      await page.keyboard.press('Tab');
      seen.push(await page.evaluate(() => [document.activeElement.id, getComputedStyle(document.activeElement).outlineStyle]));
    }
    assert.deepEqual(seen.map(([id]) => id), ['picture', 'scenes-button', 'edit-button', 'plan-button', 'error-button',
      'method-button', 'reset-button', 'link-button', 'curl-button', 'download-button']);
    assert.ok(seen.every(([, outline]) => outline === 'solid'));
  });
});

test('a movement is spoken of once, when its picture is done', async () => {
  await onPage({ server, path: kQuickScene }, async ({ page }) => {
    await page.evaluate(() => {
      window.spoken = [];
      new MutationObserver(() => window.spoken.push(document.getElementById('spoken').textContent))
        .observe(document.getElementById('spoken'), { childList: true, characterData: true, subtree: true });
    });
    await page.focus('#picture');
    await afterMoving(page, () => page.keyboard.press('Shift+ArrowLeft'));
    await page.waitForFunction(() => window.spoken.some((text) => text !== ''));
    const spoken = (await page.evaluate(() => window.spoken)).filter((text) => text !== '');
    assert.deepEqual(spoken, ['The picture is done: 16 samples taken.']);
  });
});

test('mistakes in the editor are spoken of when their number changes, and the field leads to them', async () => {
  await onPage({ server, path: kQuickScene, expected: [/422/] }, async ({ page }) => {
    await openPanel(page, 'edit');
    await page.evaluate(() => {
      window.spoken = [];
      const state = document.getElementById('editor-state');
      new MutationObserver(() => window.spoken.push(state.textContent)).observe(state, { childList: true, characterData: true });
    });
    const judged = async (text) => {
      await page.fill('#editor-text', text);
      await page.waitForSelector('#editor-state.is-old', { state: 'attached' });
      await page.waitForSelector('#editor-state:not(.is-old)');
    };
    const good = await page.inputValue('#editor-text');
    await judged('{"objects": [{"type": "sphere", "raduis": 2}]}');
    await judged('{"objects": [{"type": "sphere", "radios": 2}]}');
    const field = page.locator('#editor-text');
    assert.equal(await field.getAttribute('aria-invalid'), 'true');
    assert.match(await page.textContent(`#${await field.getAttribute('aria-errormessage')}`), /radios/);
    await judged(good);
    assert.equal(await field.getAttribute('aria-invalid'), 'false');
    assert.deepEqual(await page.evaluate(() => window.spoken), ['1 mistake', 'Drawn']);
    assert.equal(await page.getAttribute('#editor-state', 'role'), 'status');
  });
});

test('who asked for less motion gets a camera that stops at once', async () => {
  await onPage({ server, settings: { viewport: { width: 480, height: 320 }, reducedMotion: 'reduce' }, path: kQuickScene },
    async ({ page }) => {
      const views = [];
      page.on('request', (request) => request.method() === 'PUT' && views.push(request.postDataJSON().camera.position));
      await page.focus('#picture');
      await afterMoving(page, () => page.keyboard.press('Shift+ArrowLeft'));
      await finished(page);
      assert.ok(views.every((position) => JSON.stringify(position) === JSON.stringify(views[0])), 'one step, one place');
      const durations = await page.evaluate(() => getComputedStyle(document.getElementById('hint')).transitionDuration);
      assert.match(durations, /^(1e-05s|0\.00001s|0\.01ms)(, .*)?$/);
    });
});
