// SPDX-License-Identifier: Apache-2.0
// Moving a camera about its target, by the conventions of three.js' OrbitControls. Pure functions from camera to camera,
// where a camera is the object of the scene language: {type, position, target, up, fov_y_deg | height}.
import { add, anyPerpendicular, cross, dot, length, normalize, rotateAbout, scale, sub } from './vec.js';

const kPolarMargin = 1e-3;  // radians kept from the poles, where "up" would lose its meaning
const kDegree = Math.PI / 180;
const kMaxFovDeg = 170;

const clamp = (x, low, high) => Math.min(high, Math.max(low, x));
const isOrthographic = (camera) => camera.type === 'orthographic';

// The camera's own axes (unit vectors) and its distance from the target.
export function frameOf(camera) {
  const offset = sub(camera.position, camera.target);
  const distance = length(offset);
  const back = scale(offset, 1 / distance);
  const worldUp = normalize(camera.up ?? [0, 1, 0]);
  const side = cross(worldUp, back);
  const right = length(side) > 1e-9 ? normalize(side) : anyPerpendicular(worldUp);
  return { right, up: cross(back, right), forward: scale(back, -1), worldUp, distance };
}

// Height of what the camera sees in the plane of its target, in scene units.
export function visibleHeight(camera) {
  if (isOrthographic(camera)) return camera.height;
  return 2 * length(sub(camera.position, camera.target)) * Math.tan((camera.fov_y_deg * kDegree) / 2);
}

// Turns the camera about its target: `azimuth` and `polar` are radians, positive as a drag to the right and down, which
// carries the scene along with the hand.
export function orbit(camera, azimuth, polar) {
  const { right, worldUp, distance } = frameOf(camera);
  const offset = sub(camera.position, camera.target);
  const angle = Math.acos(clamp(dot(offset, worldUp) / distance, -1, 1));
  const wanted = clamp(angle - polar, kPolarMargin, Math.PI - kPolarMargin);
  const tilted = rotateAbout(offset, right, wanted - angle);
  const turned = rotateAbout(tilted, worldUp, -azimuth);
  return { ...camera, position: add(camera.target, scale(turned, distance / length(turned))) };
}

// Slides camera and target in the plane of the picture. `dx`, `dy` are fractions of the picture's height, positive as a
// drag to the right and down; a point of the target's plane stays under the hand.
export function pan(camera, dx, dy) {
  const { right, up } = frameOf(camera);
  const height = visibleHeight(camera);
  const shift = add(scale(right, -dx * height), scale(up, dy * height));
  return { ...camera, position: add(camera.position, shift), target: add(camera.target, shift) };
}

// Comes nearer by `factor` (> 1) or draws back (< 1). The point of the target's plane that is at `cursor` stays there;
// `cursor` is measured from the picture's middle in picture heights, x to the right and y up.
export function zoom(camera, factor, cursor = { x: 0, y: 0 }) {
  const { right, up } = frameOf(camera);
  const height = visibleHeight(camera);
  const pivot = add(scale(right, cursor.x * height), scale(up, cursor.y * height));
  const toward = scale(pivot, 1 - 1 / factor);
  const target = add(camera.target, toward);
  const offset = sub(camera.position, camera.target);
  if (isOrthographic(camera)) {
    return { ...camera, height: camera.height / factor, target, position: add(target, offset) };
  }
  return { ...camera, target, position: add(target, scale(offset, 1 / factor)) };
}

// The same camera for a window of another shape: a window narrower than the picture it was made for gets a wider angle,
// so that the sides stay in sight.
export function fitToAspect(camera, pictureAspect, windowAspect) {
  const widen = Math.max(1, pictureAspect / windowAspect);
  if (widen === 1) return camera;
  if (isOrthographic(camera)) return { ...camera, height: camera.height * widen };
  const halfTan = Math.tan((camera.fov_y_deg * kDegree) / 2) * widen;
  return { ...camera, fov_y_deg: Math.min(kMaxFovDeg, (2 * Math.atan(halfTan)) / kDegree) };
}

// The keys the scene language knows, rounded to what a reader of a link or a command wants to see.
export function toSceneCamera(camera) {
  const round = (x) => Number(x.toPrecision(6));
  const out = { type: camera.type ?? 'perspective' };
  for (const key of ['position', 'target', 'up']) if (camera[key]) out[key] = camera[key].map(round);
  if (isOrthographic(camera)) out.height = round(camera.height);
  else out.fov_y_deg = round(camera.fov_y_deg);
  return out;
}
