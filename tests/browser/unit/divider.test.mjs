// SPDX-License-Identifier: Apache-2.0
// Where a divider stands after pointers and keys have moved it.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { columnsLeft, shareAfterKey, shareAt } from '../../../web/js/divider.js';

test('the divider is where the pointer is, and no farther than the edges', () => {
  const box = { left: 100, width: 400 };
  assert.deepEqual([0, 100, 300, 500, 900].map((x) => shareAt(x, box)), [0, 0, 0.5, 1, 1]);
});

test('a divider that is taken hold of beside its middle does not jump', () => {
  const box = { left: 0, width: 400 };
  assert.equal(shareAt(207, box, 7), 0.5);
  assert.equal(shareAt(307, box, 7), 0.75);
});

test('arrow keys step by a percent, with Shift and by page keys ten, Home and End go to the edges', () => {
  for (const [key, shifted, share] of [['ArrowRight', false, 0.51], ['ArrowUp', false, 0.51], ['ArrowLeft', false, 0.49],
    ['ArrowDown', false, 0.49], ['ArrowRight', true, 0.6], ['ArrowLeft', true, 0.4], ['PageUp', false, 0.6],
    ['PageDown', false, 0.4], ['Home', false, 0], ['End', false, 1]]) {
    assert.equal(shareAfterKey(0.5, key, shifted), share, key);
  }
  assert.equal(shareAfterKey(1, 'ArrowRight'), 1);
  assert.equal(shareAfterKey(0, 'PageDown'), 0);
  assert.equal(shareAfterKey(0.5, 'Tab'), null);
});

test('a hundred steps lead from edge to edge', () => {
  let share = 0;
  for (let i = 0; i < 100; ++i) share = shareAfterKey(share, 'ArrowRight');
  assert.equal(share, 1);
});

test('columns to the left and to the right make the whole picture', () => {
  assert.deepEqual([0, 0.25, 0.5, 1].map((share) => columnsLeft(share, 641)), [0, 160, 321, 641]);
});
