// SPDX-License-Identifier: Apache-2.0
// What draws a picture: what the server offers, what the scene says and what the user wishes over it.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { kNoWords, knownWish, methodName, methodOf, nameOf, wishAfterEdit, wishWith, wordsOf } from '../../../web/js/methods.js';

const kSchema = {
  properties: { render: { title: 'How', $ref: '#/$defs/render' } },
  $defs: {
    render: { properties: { algorithm: { enum: ['raytrace', 'zbuffer'], default: 'raytrace' }, shading: { $ref: '#/$defs/shading' } } },
    shading: { enum: ['phong', 'flat'] },
  },
};
const kWords = wordsOf(kSchema);

test('the words are those of the schema, wherever it defines them', () => {
  assert.deepEqual(kWords, {
    algorithm: { words: ['raytrace', 'zbuffer'], first: 'raytrace' }, shading: { words: ['phong', 'flat'], first: 'phong' },
  });
});

test('the wish goes before the scene, and the scene before what is usual', () => {
  assert.deepEqual(methodOf(undefined, {}, kWords), { algorithm: 'raytrace', shading: 'phong' });
  assert.deepEqual(methodOf({ algorithm: 'zbuffer', seed: 1 }, {}, kWords), { algorithm: 'zbuffer', shading: 'phong' });
  assert.deepEqual(methodOf({ algorithm: 'zbuffer' }, { algorithm: 'raytrace', shading: 'flat' }, kWords),
    { algorithm: 'raytrace', shading: 'flat' });
  assert.deepEqual(methodOf({}, {}, kNoWords), { algorithm: 'raytrace', shading: 'phong' });
});

test('to choose what the scene says is no wish', () => {
  const own = { algorithm: 'zbuffer', shading: 'phong' };
  assert.deepEqual(wishWith({}, 'algorithm', 'raytrace', own), { algorithm: 'raytrace' });
  assert.deepEqual(wishWith({ algorithm: 'raytrace', shading: 'flat' }, 'algorithm', 'zbuffer', own), { shading: 'flat' });
});

test('a wish for what the server does not know is none', () => {
  assert.deepEqual(knownWish({ algorithm: 'painter', shading: 'flat' }, kWords), { shading: 'flat' });
  assert.deepEqual(knownWish({ algorithm: 'zbuffer' }, kNoWords), {});
});

test('who writes another method into the scene gets that one; any other edit leaves the wish alone', () => {
  const wish = { algorithm: 'zbuffer', shading: 'flat' };
  assert.deepEqual(wishAfterEdit(wish, { samples: 4 }, { samples: 9 }), wish);
  assert.deepEqual(wishAfterEdit(wish, {}, { algorithm: 'warnock' }), { shading: 'flat' });
  assert.deepEqual(wishAfterEdit(wish, { shading: 'phong' }, undefined), { algorithm: 'zbuffer' });
});

test('a word that is new to the page is told as it is', () => {
  assert.equal(nameOf('binary_space'), 'Binary space');
  assert.equal(methodName({ algorithm: 'zbuffer', shading: 'gouraud' }), 'Z-buffer, Gouraud');
});
