// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { watchPixelRatio } from '../../../web/js/dom.js';

// A screen whose queries tell a change once, as a browser's do: each of its own ratio.
function playScreen(t) {
  const screen = { queries: new Map(), glance: null };
  globalThis.devicePixelRatio = 1;
  globalThis.matchMedia = (media) => {
    if (!screen.queries.has(media)) screen.queries.set(media, new EventTarget());
    return screen.queries.get(media);
  };
  t.mock.method(globalThis, 'setInterval', (look) => { screen.glance = look; });
  t.after(() => {
    delete globalThis.devicePixelRatio;
    delete globalThis.matchMedia;
  });
  screen.change = (ratio) => {
    const old = screen.queries.get(`(resolution: ${devicePixelRatio}dppx)`);
    globalThis.devicePixelRatio = ratio;
    old?.dispatchEvent(new Event('change'));
  };
  return screen;
}

test('every change of the pixel ratio is told once', (t) => {
  const screen = playScreen(t);
  const told = [];
  watchPixelRatio(() => told.push(devicePixelRatio));
  for (const ratio of [2, 1.100000023841858, 0.75, 2]) screen.change(ratio);
  screen.glance();
  assert.deepEqual(told, [2, 1.100000023841858, 0.75, 2]);
});

test('a change that no query tells is seen at the next glance', (t) => {
  const screen = playScreen(t);
  let count = 0;
  watchPixelRatio(() => ++count);
  globalThis.devicePixelRatio = 2;
  assert.equal(count, 0);
  screen.glance();
  screen.glance();
  assert.equal(count, 1);
});
