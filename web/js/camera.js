// SPDX-License-Identifier: Apache-2.0
// Moving a camera about its target, by the conventions of three.js' OrbitControls. Pure functions from camera to camera,
// where a camera is the object of the scene language: {type, position, target, up, fov_y_deg | height}.
import { add, cross, dot, length, normalize, rotateAbout, scale, sub } from './vec.js';

const kPolarMargin = 1e-3;  // radians kept from the poles, where "up" would lose its meaning; unseen as a movement
const kUpAlongViewSine = 1e-10;  // as the renderer has it
const kDegree = Math.PI / 180;
const kMaxFovDeg = 170;

const clamp = (x, low, high) => Math.min(high, Math.max(low, x));
export const isOrthographic = (camera) => camera.type === 'orthographic';

// The camera's own axes (unit vectors) and its distance from the target.
export function frameOf(camera) {
  const offset = sub(camera.position, camera.target);
  const distance = length(offset);
  const back = normalize(offset);
  const worldUp = normalize(camera.up ?? [0, 1, 0]);
  const right = normalize(cross(usableUp(worldUp, back), back));
  return { right, up: cross(back, right), forward: scale(back, -1), worldUp, distance };
}

// A camera's up says nothing where it lies along the view. There the renderer takes the world's up, +y, and in a view
// straight up or down, where that says nothing either, what has +x on the right: -z, the north of a map, looking down.
function usableUp(worldUp, back) {
  const isAlong = (a) => !(length(cross(a, back)) > kUpAlongViewSine);
  if (!isAlong(worldUp)) return worldUp;
  return isAlong([0, 1, 0]) ? [0, 0, -Math.sign(back[1])] : [0, 1, 0];
}

// Height of what the camera sees in the plane of its target, in scene units.
export function visibleHeight(camera) {
  if (isOrthographic(camera)) return camera.height;
  return 2 * length(sub(camera.position, camera.target)) * Math.tan((camera.fov_y_deg * kDegree) / 2);
}

// Turns the camera about its target: `azimuth` and `polar` are radians, positive as a drag to the right and down, which
// carries the scene along with the hand. A camera at a pole leaves it by the margin and sees the same.
export function orbit(camera, azimuth, polar) {
  if (azimuth === 0 && polar === 0) return camera;
  const { right, worldUp, distance } = frameOf(camera);
  const offset = sub(camera.position, camera.target);
  const angle = Math.atan2(length(cross(worldUp, offset)), dot(worldUp, offset));
  const wanted = clamp(angle - polar, kPolarMargin, Math.PI - kPolarMargin);
  const tilted = rotateAbout(offset, right, wanted - angle);
  const turned = rotateAbout(tilted, worldUp, -azimuth);
  return { ...camera, position: add(camera.target, scale(turned, distance / length(turned))) };
}

// Slides camera and target in the plane of the picture. `dx`, `dy` are fractions of the picture's height, positive as a
// drag to the right and down; a point of the target's plane stays under the hand.
export function pan(camera, dx, dy) {
  if (dx === 0 && dy === 0) return camera;
  const { right, up } = frameOf(camera);
  const height = visibleHeight(camera);
  return withTarget(camera, add(camera.target, add(scale(right, -dx * height), scale(up, dy * height))));
}

// The same camera with another target. The way from there to the eye keeps its digits, also far from the origin.
export function withTarget(camera, target, offset = sub(camera.position, camera.target)) {
  return { ...camera, target, position: add(target, offset) };
}

// Comes nearer by `factor` (> 1) or draws back (< 1). The point of the target's plane that is at `cursor` stays there;
// `cursor` is measured from the picture's middle in picture heights, x to the right and y up.
export function zoom(camera, factor, cursor = { x: 0, y: 0 }) {
  if (factor === 1) return camera;
  const { right, up } = frameOf(camera);
  const height = visibleHeight(camera);
  const pivot = add(scale(right, cursor.x * height), scale(up, cursor.y * height));
  const target = add(camera.target, scale(pivot, 1 - 1 / factor));
  if (isOrthographic(camera)) return { ...withTarget(camera, target), height: camera.height / factor };
  return withTarget(camera, target, scale(sub(camera.position, camera.target), 1 / factor));
}

// The same camera for a window of another shape: a window narrower than the picture it was made for gets a wider angle,
// so that the sides stay in sight.
export function fitToAspect(camera, pictureAspect, windowAspect) {
  const widen = Math.max(1, pictureAspect / windowAspect);
  if (widen === 1) return camera;
  if (isOrthographic(camera)) return { ...camera, height: camera.height * widen };
  const halfTan = Math.tan((camera.fov_y_deg * kDegree) / 2) * widen;
  const widest = Math.max(kMaxFovDeg, camera.fov_y_deg);
  return { ...camera, fov_y_deg: Math.min(widest, (2 * Math.atan(halfTan)) / kDegree) };
}

// The keys the scene language knows, and every digit: far from the origin it is the last ones that hold the view.
export function toSceneCamera(camera) {
  const { type = 'perspective', position, target, up = [0, 1, 0] } = camera;
  const lens = isOrthographic(camera) ? { height: camera.height } : { fov_y_deg: camera.fov_y_deg };
  return { type, position, target, up, ...lens };
}
