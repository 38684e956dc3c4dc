// SPDX-License-Identifier: Apache-2.0
// How far the hand may take a camera: not so near that the steps between neighbouring numbers show, and not so far that
// nothing of the scene is left. A camera that its author put outside stays until it is moved, and may come back. Pure.
import { isOrthographic, orbit, pan, withTarget, zoom } from './camera.js';
import { add, largest, length, scale, sub } from './vec.js';

const kReach = 100;           // sizes of the scene; from there it is a speck of a hundredth of the picture
const kNearest = 2 ** -32;    // of the largest coordinate: a double has 2^20 steps on the way from target to eye
const kMostCoordinate = 1e30; // of the scene language
const kMaxScaleChange = 10;   // by so much a scene may shrink or grow under a camera that stays

const clamp = (x, low, high) => Math.min(high, Math.max(low, x));
const sizeOf = (camera) => (isOrthographic(camera) ? camera.height : length(sub(camera.position, camera.target)));

// Of a scene whose finite objects lie in `bounds` {min, max} and whose own camera is `home`: {center, extent, reach} in
// scene units. Scenes of planes alone have no size; there, and around a home far outside, what home sees counts.
export function rangeOf({ min, max }, home) {
  const center = add(scale(min, 0.5), scale(max, 0.5));
  const extent = length(sub(max, min));
  const around = Math.max(extent, sizeOf(home), length(sub(home.position, home.target)), length(sub(home.target, center)));
  return { center, extent: extent || sizeOf(home), reach: Math.min(kReach * around, kMostCoordinate / 4) };
}

// The camera after a movement {azimuth, polar, panX, panY, zoomLog} as of gestures.js, `cursor` as of zoom().
export function moved(camera, part, cursor, range) {
  const panned = pan(orbit(camera, part.azimuth, part.polar), part.panX, part.panY);
  const zoomed = zoom(panned, allowedZoom(panned, Math.exp(part.zoomLog), range), cursor);
  const held = withTargetHeld(zoomed, camera, range);
  return isSound(held) ? held : camera;
}

// Whether a camera that was moved in one scene may stay in another one: it lies about where the hand could take it.
export function isAbout(camera, range) {
  const size = sizeOf(camera);
  return size * kMaxScaleChange >= nearest(camera, range) && size <= kMaxScaleChange * farthest(camera, range)
    && length(sub(camera.target, range.center)) <= kMaxScaleChange * range.reach;
}

function nearest({ target }, { extent }) {
  return kNearest * Math.max(extent, largest(target));
}

// A narrow angle sees the scene as large from farther away.
function farthest(camera, { reach }) {
  if (isOrthographic(camera)) return reach;
  return Math.min(reach / Math.min(1, 2 * Math.tan((camera.fov_y_deg * Math.PI) / 360)), kMostCoordinate / 4);
}

function allowedZoom(camera, factor, range) {
  const size = sizeOf(camera);
  const wanted = clamp(size / factor, Math.min(size, nearest(camera, range)), Math.max(size, farthest(camera, range)));
  return size / wanted;
}

// The target stays within reach of the scene; of one that was outside before, no farther out.
function withTargetHeld(camera, before, { center, reach }) {
  const allowed = Math.max(reach, length(sub(before.target, center)));
  const way = sub(camera.target, center);
  const distance = length(way);
  return distance > allowed ? withTarget(camera, add(center, scale(way, allowed / distance))) : camera;
}

// What the server takes: numbers of the scene language, and an eye that is not in its target.
function isSound(camera) {
  const numbers = [...camera.position, ...camera.target, camera.height ?? camera.fov_y_deg];
  return numbers.every((x) => Math.abs(x) <= kMostCoordinate) && camera.position.some((x, i) => x !== camera.target[i]);
}
