// SPDX-License-Identifier: Apache-2.0
// The curve of error against time: its axes, its points and its words; and the scale of the error by pixel.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { test } from 'node:test';
import { Curves, describeCurve } from '../../../web/js/curves.js';
import { kBrightest, kDarkest, kRamp, placeOnScale } from '../../../web/js/heat.js';
import { logAxis, slopeLine } from '../../../web/js/log_axis.js';

const frame = (viewSeq, spp, rmse, ms, isFinal = false) => ({ viewSeq, spp, rmse, timings: { render: ms }, isFinal });

test('on a logarithmic axis equal factors are equal distances', () => {
  const { at } = logAxis([0.003, 0.2], 200, 20, 15);
  const step = at(0.01) - at(0.02);
  assert.ok(step > 0, 'the greater error stands higher');
  for (const x of [0.003, 0.01, 0.07]) assert.ok(Math.abs(at(x) - at(2 * x) - step) < 1e-9);
});

test('an axis ends at ticks that hold all values, and its ticks are 1, 2 and 5 of a decade', () => {
  const { low, high, at, ticks } = logAxis([0.0031, 0.17], 0, 300, 20);
  assert.deepEqual([low, high], [0.002, 0.2]);
  assert.deepEqual([at(low), at(high)], [0, 300]);
  assert.deepEqual(ticks.map(({ value }) => value), [0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2]);
  assert.ok(ticks.every(({ isLabelled }) => isLabelled));
});

test('a value on a tick is its own end, whatever its bits', () => {
  for (let decade = -6; decade <= 6; ++decade) {
    for (const digit of [1, 2, 5]) {
      const value = digit * 10 ** decade;
      const { low, high } = logAxis([value, value * 100], 0, 100, 10);
      assert.ok(Math.abs(low / value - 1) < 1e-12 && Math.abs(high / value - 100) < 1e-9, `${value}: ${low} to ${high}`);
    }
  }
});

test('one value gets an axis around it', () => {
  const { low, high, at } = logAxis([0.01], 0, 100, 10);
  assert.ok(low < 0.01 && high > 0.01);
  assert.ok(at(0.01) > 0 && at(0.01) < 100);
});

test('labels never stand nearer than asked, and there is one at least', () => {
  for (const [low, high] of [[0.001, 0.01], [0.00002, 0.3], [3, 600_000], [0.0021, 0.0049], [1e-9, 1]]) {
    for (const width of [120, 250, 400]) {
      const { at, ticks } = logAxis([low, high], 0, width, 46);
      const places = ticks.filter(({ isLabelled }) => isLabelled).map(({ value }) => at(value));
      assert.ok(places.length >= 1, `${low} to ${high}`);
      for (let i = 1; i < places.length; ++i) assert.ok(places[i] - places[i - 1] >= 45.9, `${low} to ${high} in ${width}`);
    }
  }
});

test('a line of slope -1/2 halves the error in four times the time, and stays inside', () => {
  const [from, to] = slopeLine({ x: 10, y: 0.1 }, -1 / 2, 40, 0.001);
  assert.deepEqual([from, to.x], [{ x: 10, y: 0.1 }, 40]);
  assert.ok(Math.abs(to.y - 0.05) < 1e-15);
  const [, end] = slopeLine({ x: 10, y: 0.1 }, -1 / 2, 1e6, 0.05);
  assert.ok(Math.abs(end.x - 40) < 1e-9 && end.y === 0.05);
});

test('a pass is a point once its error is known, and the same pass told twice is one', () => {
  const curves = new Curves();
  for (const f of [frame(1, 1, null, 5), frame(1, 2, 0.05, 9), frame(1, 4, 0.03, 20), frame(1, 4, 0.03, 20, true)]) curves.take(f);
  assert.deepEqual(curves.current.points, [{ spp: 2, rmse: 0.05, ms: 9 }, { spp: 4, rmse: 0.03, ms: 20 }]);
  assert.ok(curves.current.isFinal);
  assert.equal(curves.before, null);
});

test('another view starts anew, and the last finished curve stays to compare with', () => {
  const curves = new Curves();
  curves.take(frame(1, 2, 0.05, 9, true));
  curves.take(frame(2, 1, null, 3, true));  // moving: one sample, of which nothing is known
  assert.deepEqual(curves.current.points, []);
  assert.deepEqual(curves.before.points.map(({ rmse }) => rmse), [0.05]);
  curves.take(frame(3, 2, 0.04, 9));
  curves.take(frame(4, 2, 0.03, 9));
  curves.take(frame(3, 4, 0.02, 20));
  assert.deepEqual(curves.current.points.map(({ rmse }) => rmse), [0.03], 'what comes late from an older view is left out');
  assert.deepEqual(curves.before.points.map(({ rmse }) => rmse), [0.05], 'a view that was left before its end is none to compare with');
});

test('an exact picture, whose error is 0, has no place on a logarithmic scale', () => {
  const curves = new Curves();
  curves.take(frame(1, 2, 0, 9, true));
  assert.deepEqual(curves.current.points, []);
  assert.deepEqual(curves.newest, { spp: 2, rmse: 0, ms: 9 }, 'but it is told');
});

test('the curve in words says where it begins and ends', () => {
  assert.match(describeCurve([]), /nothing is known/);
  const words = describeCurve([{ spp: 2, rmse: 0.05, ms: 90 }, { spp: 8, rmse: 0.0123, ms: 1500 }]);
  assert.match(words, /from 0\.050 after 0\.090 s to 0\.012 after 1\.5 s, in 2 passes/);
});

test('the colours of the error by pixel are those that the renderer paints with', async () => {
  const source = await readFile(new URL('../../../renderer/film/heat_map.cpp', import.meta.url), 'utf8');
  const ramp = /kRamp\{\{(.*?)\}\};/s.exec(source)[1];
  assert.deepEqual([...ramp.matchAll(/\{?\{([\d., ]+)\}/g)].map(([, row]) => row.split(',').map(Number)), kRamp);
  const [, dark, bright] = /kDarkest = ([\d.]+) \/ 255\.0, kBrightest = ([\d.]+) \/ 255\.0/.exec(source);
  assert.deepEqual([kDarkest * 255, kBrightest * 255], [Number(dark), Number(bright)]);
});

test('the scale is logarithmic, and what is beyond it stands at its ends', () => {
  assert.deepEqual([kDarkest / 9, kDarkest, kBrightest, 1].map(placeOnScale), [0, 0, 1, 1]);
  assert.ok(Math.abs(placeOnScale(Math.sqrt(kDarkest * kBrightest)) - 0.5) < 1e-12);
});
