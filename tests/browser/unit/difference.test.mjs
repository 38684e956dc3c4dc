// SPDX-License-Identifier: Apache-2.0
// How far two pictures are apart, on pictures of a few pixels that are counted by hand.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { differenceOf, drawDifference } from '../../../web/js/difference.js';
import { ratioText, shareText, stepsText } from '../../../web/js/numbers.js';

const rgba = (...pixels) => Uint8ClampedArray.from(pixels.flatMap((rgb) => [...rgb, 255]));

test('a picture differs from itself nowhere', () => {
  const picture = rgba([0, 10, 20], [255, 255, 255], [7, 8, 9]);
  assert.deepEqual(differenceOf(picture, picture), { pixels: 3, differing: 0, rms: 0, largest: 0 });
});

test('black and white are wholly apart', () => {
  assert.deepEqual(differenceOf(rgba([0, 0, 0], [0, 0, 0]), rgba([255, 255, 255], [255, 255, 255])),
    { pixels: 2, differing: 2, rms: 1, largest: 1 });
});

test('a pixel differs if any of its channels does, whichever picture is the brighter', () => {
  const a = rgba([1, 2, 3], [1, 2, 3], [1, 2, 3], [1, 2, 3]);
  const b = rgba([1, 2, 3], [0, 2, 3], [1, 4, 3], [1, 2, 8]);
  const { pixels, differing, largest, rms } = differenceOf(a, b);
  assert.deepEqual([pixels, differing, largest], [4, 3, 5 / 255]);
  assert.ok(Math.abs(rms - Math.sqrt((1 + 4 + 25) / 12) / 255) < 1e-15);
  assert.deepEqual(differenceOf(b, a), differenceOf(a, b));
});

test('the difference is drawn brightened, each channel for itself, and never brighter than white', () => {
  const a = rgba([10, 0, 200], [0, 0, 0]);
  const b = rgba([7, 100, 200], [0, 1, 16]);
  const drawn = (gain) => {
    const out = new Uint8ClampedArray(8);
    drawDifference(a, b, gain, out);
    return [...out];
  };
  assert.deepEqual(drawn(1), [3, 100, 0, 255, 0, 1, 16, 255]);
  assert.deepEqual(drawn(4), [12, 255, 0, 255, 0, 4, 64, 255]);
  assert.deepEqual(drawn(16), [48, 255, 0, 255, 0, 16, 255, 255]);
});

test('only nothing is told as nothing, and only all as all', () => {
  assert.deepEqual([[0, 9], [1, 1e6], [1, 400], [1, 3], [999_999, 1e6], [9, 9]].map(([part, whole]) => shareText(part, whole)),
    ['0 %', 'under 0.01 %', '0.25 %', '33.3 %', 'over 99.9 %', '100 %']);
  assert.deepEqual([0, 1e-5, 1 / 255, 0.5].map(stepsText),
    ['0 of 255 steps', 'under 0.1 of 255 steps', '1 of 255 steps', '130 of 255 steps']);
});

test('a ratio says how many times as much, where there is something to be a multiple of', () => {
  assert.deepEqual([[2, 1], [1, 3], [3, 1000], [5, 0], [0, 5], [0, 0]].map(([a, b]) => ratioText(a, b)),
    ['× 0.5', '× 3', '× 333', '× 0', '–', '–']);
});
