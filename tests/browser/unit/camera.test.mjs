// SPDX-License-Identifier: Apache-2.0
// The camera's movements, held against geometry: what stays where, and what comes back.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { fitToAspect, frameOf, orbit, pan, toSceneCamera, visibleHeight, zoom } from '../../../web/js/camera.js';
import { dot, length, sub } from '../../../web/js/vec.js';

const kCamera = { type: 'perspective', position: [7, 4, 10], target: [0.5, 0.2, -1], up: [0, 1, 0], fov_y_deg: 30 };
const kOrthographic = { type: 'orthographic', position: [3, 6, 2], target: [0, 1, 0], up: [0, 1, 0], height: 5 };
const kTilted = { ...kCamera, up: [0.3, 0.9, -0.2] };

const near = (a, b, tolerance = 1e-9) =>
  [a].flat().forEach((x, i) => assert.ok(Math.abs(x - [b].flat()[i]) <= tolerance, `${a} is not ${b}`));

// Where a point appears, from the middle in picture heights, y up.
function project(camera, point) {
  const { right, up, forward } = frameOf(camera);
  const v = sub(point, camera.position);
  const height = camera.type === 'orthographic'
    ? camera.height : 2 * dot(v, forward) * Math.tan((camera.fov_y_deg * Math.PI) / 360);
  return [dot(v, right) / height, dot(v, up) / height];
}

// The point of the target's plane that appears at (x, y).
function unproject(camera, x, y) {
  const { right, up } = frameOf(camera);
  const height = visibleHeight(camera);
  return camera.target.map((t, i) => t + x * height * right[i] + y * height * up[i]);
}

test('an orbit keeps the target and the distance', () => {
  for (const camera of [kCamera, kTilted, kOrthographic]) {
    const moved = orbit(camera, 0.7, -0.4);
    assert.deepEqual(moved.target, camera.target);
    near(length(sub(moved.position, moved.target)), length(sub(camera.position, camera.target)));
  }
});

test('an orbit and its opposite cancel out', () => {
  near(orbit(orbit(kCamera, 0.5, 0), -0.5, 0).position, kCamera.position);
  near(orbit(orbit(kTilted, 0, 0.3), 0, -0.3).position, kTilted.position);
});

test('a drag over the height of the picture is a full turn', () => {
  near(orbit(kCamera, 2 * Math.PI, 0).position, kCamera.position);
});

test('a drag to the right brings the left side of the scene to the front', () => {
  const camera = { ...kCamera, position: [0, 0, 10], target: [0, 0, 0] };
  const moved = orbit(camera, 0.1, 0);
  assert.ok(moved.position[0] < 0);
  assert.ok(project(moved, [0, 0, 1])[0] > 0, 'the near side goes along with the hand');
});

test('a drag down lifts the camera', () => {
  assert.ok(orbit(kCamera, 0, 0.2).position[1] > kCamera.position[1]);
});

test('the poles are never crossed, and the camera comes back from them', () => {
  for (const polar of [20, -20]) {
    const atPole = orbit(kCamera, 0, polar);
    const { right, up, distance } = frameOf(atPole);
    near(length(right), 1);
    near(length(up), 1);
    const back = orbit(atPole, 0, -Math.sign(polar) * 0.5);
    near(length(sub(back.position, back.target)), distance);
    assert.ok(Math.abs(back.position[1] - atPole.position[1]) > 0.01);
  }
});

test('a camera straight down has north up and east on the right, as a map', () => {
  const { right, up } = frameOf({ ...kCamera, position: [3, 9, -2], target: [3, 0, -2], up: [0, 2, 0] });
  near(right, [1, 0, 0]);
  near(up, [0, 0, -1]);
});

test('a camera straight up is the one that tilts on past the horizon from a view to the north', () => {
  const up = { ...kCamera, position: [0, -9, 0], target: [0, 0, 0] };
  near(frameOf(up).right, [1, 0, 0]);
  near(frameOf(up).up, [0, 0, 1]);
  const tilted = frameOf(orbit({ ...up, position: [0, 0, 9] }, 0, -Math.PI));
  near(tilted.right, [1, 0, 0]);
  near(tilted.up, [0, 0, 1], 2e-3);
});

const kAlongView = [[0, 1, 0], [0, 0, 1], [1, 0, 0], [1, 2, -3], [0.1, 5, 0], [0, -1, 1], [1e-200, 0, 0], [0, 1e30, 0]];

test('no movement begins with a jump, also where up lies along the view', () => {
  const small = 2 * Math.PI / 400;  // a pixel of a picture of 400
  for (const up of kAlongView) {
    for (const side of [1, -1]) {
      for (const kind of [kCamera, kOrthographic]) {
        const back = up.map((x) => (side * 7 * x) / Math.hypot(...up));
        const camera = { ...kind, up, target: [1, 2, 3], position: back.map((x, i) => [1, 2, 3][i] + x) };
        const before = frameOf(camera);
        for (const [azimuth, polar] of [[small, 0], [0, small], [0, -small], [-small, small], [1e-9, 0]]) {
          const after = frameOf(orbit(camera, azimuth, polar));
          for (const axis of ['right', 'up', 'forward']) {
            near(after[axis], before[axis], Math.abs(azimuth) + Math.abs(polar) + 1.1e-3);
          }
        }
      }
    }
  }
});

test('a camera near a pole but not in it keeps its place through a turn', () => {
  const camera = { ...kCamera, target: [0, 0, 0], position: [0, 9, 9e-5] };
  near(Math.hypot(...orbit(camera, 1.3, 0).position), Math.hypot(...camera.position));
  near(orbit(orbit(camera, 1.3, 0), -1.3, 0).position, camera.position, 1e-2);
});

test('no movement changes no digit', () => {
  for (const camera of [kCamera, kTilted, kOrthographic]) {
    assert.equal(zoom(pan(orbit(camera, 0, 0), 0, 0), 1), camera);
  }
});

test('far from the origin an orbit is as it is there, to the step of the coordinates', () => {
  const far = [1e7, -7e6, 3e6];
  const offset = [4, 2.5, -3];
  const there = (target) => ({ ...kCamera, target, position: offset.map((x, i) => x + target[i]) });
  let [near0, away] = [there([0, 0, 0]), there(far)];
  for (let i = 0; i < 100; ++i) [near0, away] = [near0, away].map((camera) => orbit(camera, 0.03, i % 2 ? 0.02 : -0.02));
  near(sub(away.position, away.target), near0.position, 1e-7);
});

test('a pan keeps the point of the target plane under the hand', () => {
  for (const camera of [kCamera, kTilted, kOrthographic]) {
    const point = unproject(camera, -0.2, 0.1);
    near(project(pan(camera, 0.3, 0.15), point), [0.1, -0.05]);  // y counts down in a drag and up in the picture
  }
});

test('a zoom keeps the point under the cursor where it is', () => {
  for (const camera of [kCamera, kTilted, kOrthographic]) {
    for (const factor of [1.7, 0.4]) {
      const point = unproject(camera, 0.31, -0.22);
      const zoomed = zoom(camera, factor, { x: 0.31, y: -0.22 });
      near(project(zoomed, point), [0.31, -0.22]);
      near(visibleHeight(zoomed), visibleHeight(camera) / factor);
    }
  }
});

test('a zoom in the middle leaves the target alone', () => {
  near(zoom(kCamera, 3).target, kCamera.target);
});

test('a narrow window sees as far to the sides as the picture that was composed', () => {
  const sideOf = (camera, aspect) => visibleHeight(camera) * aspect;
  for (const camera of [kCamera, kOrthographic]) {
    const fitted = fitToAspect(camera, 16 / 9, 9 / 19);
    near(sideOf(fitted, 9 / 19), sideOf(camera, 16 / 9), 1e-9);
  }
});

test('a wide window keeps the height of the picture', () => {
  assert.equal(fitToAspect(kCamera, 16 / 9, 21 / 9), kCamera);
});

test('a window never narrows an angle that is wide by itself', () => {
  const wide = { ...kCamera, fov_y_deg: 176 };
  assert.ok(fitToAspect(wide, 16 / 9, 9 / 19).fov_y_deg >= 176);
});

test('a camera for the server has every digit of its own', () => {
  const digits = [10000000.123456789, -0.1 - 0.2, 1 / 3];
  for (const camera of [{ ...kCamera, fov_y_deg: 40 / 3 }, { ...kOrthographic, height: 1e-12 / 3 }]) {
    const written = { ...camera, position: digits, target: digits.map((x) => x / 7), up: [1e-17, 1 / 7, 2e29 / 3] };
    assert.deepEqual(JSON.parse(JSON.stringify(toSceneCamera(written))), written);
  }
});

test('a camera for the server has exactly the keys of its kind', () => {
  assert.deepEqual(Object.keys(toSceneCamera(kCamera)).sort(), ['fov_y_deg', 'position', 'target', 'type', 'up']);
  assert.deepEqual(Object.keys(toSceneCamera(kOrthographic)).sort(), ['height', 'position', 'target', 'type', 'up']);
});
