// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Inertia } from '../../../web/js/inertia.js';
import { fullSize, kTargetMs, nextScale } from '../../../web/js/resolution.js';

function total(inertia, stepMs) {
  let sum = 0;
  let steps = 0;
  while (inertia.isMoving && ++steps < 10000) sum += inertia.take(stepMs).azimuth;
  return { sum, ms: steps * stepMs };
}

test('inertia gives out exactly what was pushed, at any frame rate', () => {
  for (const stepMs of [4, 16.7, 33, 50]) {
    const inertia = new Inertia();
    inertia.push({ azimuth: 1.25 });
    const { sum, ms } = total(inertia, stepMs);
    assert.ok(Math.abs(sum - 1.25) < 1e-12);
    assert.ok(ms < 1000, `still moving after ${ms} ms`);
  }
});

test('inertia at two frame rates is at the same place at the same time', () => {
  const at = (stepMs) => {
    const inertia = new Inertia();
    inertia.push({ panX: 1 });
    let sum = 0;
    for (let t = 0; t < 60; t += stepMs) sum += inertia.take(stepMs).panX;
    return sum;
  };
  assert.ok(Math.abs(at(5) - at(20)) < 1e-12);
});

test('with reduced motion a push is made at once', () => {
  const inertia = new Inertia(0);
  inertia.push({ polar: 0.5 });
  assert.equal(inertia.take(16).polar, 0.5);
  assert.equal(inertia.isMoving, false);
});

test('the moving picture settles where a view takes as long as it may', () => {
  const fullMs = 900;      // for the full picture, by the number of pixels
  const overheadMs = 12;
  let scale = 0.4;
  for (let i = 0; i < 30; ++i) {
    const renderMs = fullMs * scale * scale;
    scale = nextScale(scale, renderMs + overheadMs, renderMs);
  }
  const settledMs = fullMs * scale * scale + overheadMs;
  assert.ok(Math.abs(settledMs - kTargetMs) < 1, `settled at ${settledMs} ms`);
  assert.ok(1000 / settledMs > 15);
});

test('a far server does not make the picture small: distance is not paid in pixels', () => {
  let scale = 0.5;
  for (let i = 0; i < 30; ++i) scale = nextScale(scale, 200 + 30 * scale * scale, 30 * scale * scale);
  assert.ok(scale > 0.7);
});

test('a fast server draws the full picture while moving, a stuck one a small one', () => {
  let fast = 0.2;
  let stuck = 1;
  for (let i = 0; i < 30; ++i) {
    fast = nextScale(fast, 5, 3);
    stuck = nextScale(stuck, 5000);
  }
  assert.equal(fast, 1);
  assert.ok(stuck > 0.1 && stuck < 0.2);
});

test('the full picture follows the screen up to a cap', () => {
  assert.deepEqual(fullSize(1440, 900, 1), { width: 1440, height: 900 });
  assert.deepEqual(fullSize(360, 740, 2), { width: 720, height: 1480 });
  assert.deepEqual(fullSize(360, 740, 4), { width: 720, height: 1480 });
  const huge = fullSize(3840, 2160, 2);
  assert.ok(huge.width * huge.height <= 4.01e6);
  assert.ok(Math.abs(huge.width / huge.height - 16 / 9) < 0.002);
});
