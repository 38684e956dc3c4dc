// SPDX-License-Identifier: Apache-2.0
// How far the hand takes a camera, in scenes of every size and place, and that it always comes back.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { orbit, visibleHeight } from '../../../web/js/camera.js';
import { isAbout, moved, rangeOf } from '../../../web/js/range.js';
import { length, scale, sub } from '../../../web/js/vec.js';

const kNotch = 0.11;
const kStill = { azimuth: 0, polar: 0, panX: 0, panY: 0, zoomLog: 0 };
const kSizes = [1e-12, 1e-3, 1, 5000, 1e15, 1e22];
const kMiddles = [[0, 0, 0], [1, -0.5, 0.25], [1e7, -7e6, 3e6]];  // in sizes of the scene
const kLenses = [
  { type: 'perspective', fov_y_deg: 40 }, { type: 'perspective', fov_y_deg: 0.01 }, { type: 'perspective', fov_y_deg: 179 },
  { type: 'orthographic' },
];

// A scene of that size about that middle, its camera three sizes away, and the range of it.
function sceneOf(size, middle, lens) {
  const center = scale(middle, Math.min(size, 1e20));
  const bounds = { min: center.map((x) => x - size / 2), max: center.map((x) => x + size / 2) };
  const position = [2, 1.5, 2].map((x, i) => x * size + center[i]);
  const camera = { ...lens, ...(lens.fov_y_deg ? {} : { height: 2 * size }), position, target: center, up: [0, 1, 0] };
  return { camera, range: rangeOf(bounds, camera), size: length(sub(bounds.max, bounds.min)) };
}

function forAll(body) {
  for (const size of kSizes) for (const middle of kMiddles) for (const lens of kLenses) body(sceneOf(size, middle, lens), lens);
}

const distanceOf = ({ position, target }) => length(sub(position, target));
const isSound = ({ position, target, height = 1 }) => [...position, ...target, height].every((x) => Math.abs(x) <= 1e30)
  && position.some((x, i) => x !== target[i]);

function zoomed(camera, notches, range, cursor = { x: 0.3, y: -0.2 }) {
  let now = camera;
  for (let i = 0; i < Math.abs(notches); ++i) now = moved(now, { ...kStill, zoomLog: Math.sign(notches) * kNotch }, cursor, range);
  return now;
}

test('zooming out ends where the scene is a hundredth of the picture, and zooming in brings it back', () => {
  forAll(({ camera, range, size }, { fov_y_deg: fov = 40 }) => {
    const out = zoomed(camera, -650, range);
    assert.ok(isSound(out));
    const seen = visibleHeight(out);
    const around = Math.max(size, distanceOf(camera), camera.height ?? 0);
    assert.ok(seen <= 101 * around * Math.max(1, 2 * Math.tan(fov * Math.PI / 360)), `${seen} of ${size}`);
    assert.ok(seen >= 9 * around, `${seen} of ${size}`);
    const back = zoomed(out, 60, range, { x: 0, y: 0 });
    assert.ok(visibleHeight(back) < 0.01 * seen, 'at the end nothing is stored up that has to be undone first');
  });
});

test('a zoom of any size in one step is held like one of many', () => {
  forAll(({ camera, range }) => {
    for (const zoomLog of [-71.5, -5000, 5000]) assert.ok(isSound(moved(camera, { ...kStill, zoomLog }, { x: 0.4, y: 0.4 }, range)));
    const [step, steps] = [moved(camera, { ...kStill, zoomLog: -5000 }, { x: 0, y: 0 }, range), zoomed(camera, -650, range, { x: 0, y: 0 })];
    assert.ok(Math.abs(visibleHeight(step) / visibleHeight(steps) - 1) < 1e-6);
  });
});

test('zooming in ends while the eye can still be turned about its target', () => {
  forAll(({ camera, range }) => {
    const near = zoomed(camera, 650, range);
    assert.ok(isSound(near));
    let turned = near;
    for (let i = 0; i < 64; ++i) turned = moved(turned, { ...kStill, azimuth: Math.PI / 32 }, { x: 0, y: 0 }, range);
    const drift = length(sub(sub(turned.position, turned.target), sub(near.position, near.target)));
    assert.ok(drift < 1e-4 * distanceOf(near), `a full turn ends ${drift / distanceOf(near)} beside its begin`);
    assert.ok(visibleHeight(zoomed(near, -400, range)) > 1e3 * visibleHeight(near));
  });
});

test('panning ends within reach of the scene, and comes back', () => {
  forAll(({ camera, range, size }) => {
    let panned = zoomed(camera, -650, range, { x: 0, y: 0 });
    for (let i = 0; i < 500; ++i) panned = moved(panned, { ...kStill, panX: 1, panY: 0.5 }, { x: 0, y: 0 }, range);
    assert.ok(isSound(panned));
    const far = length(sub(panned.target, range.center));
    assert.ok(far <= 1.001 * range.reach, `${far} of ${range.reach}`);
    assert.ok(far > 10 * size, `${far} of ${size}`);
    const step = range.reach / visibleHeight(panned) / 4;
    const back = moved(panned, { ...kStill, panX: -step, panY: -step / 2 }, { x: 0, y: 0 }, range);
    assert.ok(length(sub(back.target, range.center)) < far);
  });
});

test('at the largest coordinates of the scene language a camera stays within them', () => {
  for (const size of [1e28, 3e29]) {
    const { camera, range } = sceneOf(size, [0, 0, 0], kLenses[1]);
    assert.ok(isSound(zoomed(camera, -650, range)));
    assert.ok(isSound(moved(zoomed(camera, -100, range), { ...kStill, panX: 1e3 }, { x: 0, y: 0 }, range)));
  }
});

test('a camera that its author put outside does not jump, and may only come nearer', () => {
  const { range } = sceneOf(1, [0, 0, 0], kLenses[0]);
  const afar = { ...kLenses[0], position: [1e9, 0, 0], target: [9e8, 0, 0], up: [0, 1, 0] };
  const turned = moved(afar, { ...kStill, azimuth: 0.01 }, { x: 0, y: 0 }, range);
  assert.deepEqual(turned, orbit(afar, 0.01, 0));
  assert.ok(distanceOf(zoomed(afar, -10, range)) <= distanceOf(afar) * (1 + 1e-12));
  assert.ok(distanceOf(zoomed(afar, 10, range)) < distanceOf(afar) / 2.9);
  const near = { ...afar, position: [1e-15, 0, 0], target: [0, 0, 0] };
  assert.ok(distanceOf(zoomed(near, 10, range)) >= 1e-15 * (1 - 1e-12));
  assert.ok(distanceOf(zoomed(near, -10, range)) > 2.9e-15);
});

test('a scene of planes alone is measured by its own camera', () => {
  const home = { ...kLenses[0], position: [0, 30, 40], target: [0, 0, 0], up: [0, 1, 0] };
  const range = rangeOf({ min: [0, 0, 0], max: [0, 0, 0] }, home);
  const out = zoomed(home, -650, range);
  assert.ok(distanceOf(out) > 4e3 && distanceOf(out) < 1e4);
  assert.ok(distanceOf(zoomed(home, 650, range)) > 0);
});

test('a camera that was moved stays in a scene that changes, and not in one that lies elsewhere', () => {
  const { camera, range } = sceneOf(2, [0, 0, 0], kLenses[0]);
  const out = zoomed(camera, -650, range);
  for (const size of [1, 2, 15]) assert.ok(isAbout(out, sceneOf(size, [0, 0, 0], kLenses[0]).range), `zoomed out, size ${size}`);
  assert.ok(!isAbout(camera, sceneOf(2, [1e7, 0, 0], kLenses[0]).range));
  assert.ok(!isAbout(camera, sceneOf(1e-12, [0, 0, 0], kLenses[0]).range));
  assert.ok(!isAbout(camera, sceneOf(1e15, [0, 0, 0], kLenses[0]).range));
});
