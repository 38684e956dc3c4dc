// SPDX-License-Identifier: Apache-2.0
// Two pictures of one view: one after the other, the newest order wins, and what is in the way is lived through. The
// server is played by the test.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Problem } from '../../../web/js/api.js';
import { Comparison } from '../../../web/js/compare.js';

const kMethods = [{ algorithm: 'raytrace', shading: 'phong' }, { algorithm: 'zbuffer', shading: 'gouraud' }];
const order = (more = {}) => ({ text: '{}', camera: { fov_y_deg: 40 }, image: { width: 4, height: 3 }, samples: 16, methods: kMethods, ...more });
const turn = () => new Promise((resolve) => setImmediate(resolve));

// A server that answers renders when the test says so, and what the comparison told.
function play() {
  const told = [];
  const asked = [];    // {body, answer(report), refuse(error), isOff}
  const stored = [];
  let running = 0;
  const api = {
    storeScene: async (text) => `id${stored.push(text)}`,
    renderStill: (body, { signal }) => new Promise((resolve, reject) => {
      assert.ok(++running === 1, 'one picture at a time');
      const end = (settle) => (value) => { --running; settle(value); };
      const one = { body, answer: end(resolve), refuse: end(reject), isOff: false };
      signal.addEventListener('abort', () => {
        one.isOff = true;
        one.refuse(new DOMException('called off', 'AbortError'));
      }, { once: true });
      asked.push(one);
    }),
  };
  const tell = (name) => (...what) => told.push([name, ...what]);
  const comparison = new Comparison({ api, on: {
    begin: () => told.push(['begin']), side: tell('side'), hindered: tell('hindered'), end: tell('end'),
  } });
  return { comparison, told, asked, stored };
}

test('both sides are one scene, one view and as many samples, by their own methods, one after the other', async () => {
  const { comparison, told, asked, stored } = play();
  assert.equal(comparison.want(order()), false);
  await turn();
  assert.equal(asked.length, 1, 'B waits for A');
  asked[0].answer({ blob: 'a' });
  await turn();
  asked[1].answer({ blob: 'b' });
  await turn();
  assert.deepEqual(told, [['begin'], ['side', 0, { blob: 'a' }], ['side', 1, { blob: 'b' }], ['end']]);
  const [a, b] = asked.map(({ body }) => body);
  assert.deepEqual({ ...a, render: { ...a.render, ...kMethods[1] } }, b);
  assert.deepEqual([a.scene, a.render.algorithm, a.render.samples, a.render.rmse], ['id1', 'raytrace', 16, null]);
  assert.equal(stored.length, 1);
  assert.equal(comparison.want(order()), true, 'it is there already');
});

test('a newer order calls the older one off, and nothing of that is told any more', async () => {
  const { comparison, told, asked } = play();
  comparison.want(order());
  await turn();
  comparison.want(order({ samples: 4 }));
  comparison.want(order({ samples: 9 }));
  await turn();
  assert.ok(asked[0].isOff);
  assert.deepEqual(asked.map(({ body }) => body.render.samples), [16, 9], 'what was wanted in between is left out');
  asked[1].answer({ blob: 'a' });
  await turn();
  asked[2].answer({ blob: 'b' });
  await turn();
  assert.deepEqual(told.map(([name]) => name), ['begin', 'begin', 'side', 'side', 'end']);
});

test('what was stopped half way is drawn again when it is wanted again', async () => {
  const { comparison, asked } = play();
  comparison.want(order());
  await turn();
  comparison.stop();
  await turn();
  assert.ok(asked[0].isOff);
  assert.equal(comparison.want(order()), false);
  await turn();
  assert.equal(asked.length, 2);
});

test('a side that is refused says why, and the other is drawn', async () => {
  const { comparison, told, asked } = play();
  comparison.want(order());
  await turn();
  const refusal = new Problem(422, { detail: 'too many triangles' });
  asked[0].refuse(refusal);
  await turn();
  asked[1].answer({ blob: 'b' });
  await turn();
  assert.deepEqual(told, [['begin'], ['side', 0, { error: refusal }], ['side', 1, { blob: 'b' }], ['end']]);
  assert.equal(comparison.want(order()), false, 'and may be asked for again');
});

test('a scene that the server no longer has is stored once more', async () => {
  const { comparison, told, asked, stored } = play();
  comparison.want(order());
  await turn();
  asked[0].refuse(new Problem(422, { errors: [{ pointer: '/scene', code: 'unknown_scene' }] }));
  await turn();
  assert.equal(stored.length, 2);
  assert.equal(asked[1].body.scene, 'id2');
  asked[1].refuse(new Problem(422, { errors: [{ pointer: '/scene', code: 'unknown_scene' }] }));
  await turn();
  assert.equal(told[1][2].error.status, 422, 'but not for ever');
});

test('a busy server is waited for, unless something newer is wanted', async () => {
  const { comparison, told, asked } = play();
  comparison.want(order());
  await turn();
  asked[0].refuse(new Problem(503, {}, 1));
  await turn();
  assert.deepEqual(told.at(-1), ['hindered', 0, 'busy']);
  comparison.want(order({ samples: 4 }));
  await turn();
  assert.equal(asked[1].body.render.samples, 4);
});
