// SPDX-License-Identifier: Apache-2.0
// Vectors as arrays of three numbers. Pure; nothing here changes its arguments.

export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const length = (a) => Math.hypot(a[0], a[1], a[2]);
export const largest = (a) => Math.max(...a.map(Math.abs));
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

// Of any vector but 0, also where the inverse of its length leaves the range of a number.
export function normalize(a) {
  const most = largest(a);
  const moderate = a.map((x) => x / most);
  return scale(moderate, 1 / length(moderate));
}

// Rotates `v` about the unit vector `axis` (Rodrigues' formula).
export function rotateAbout(v, axis, angleRad) {
  const c = Math.cos(angleRad);
  const s = Math.sin(angleRad);
  return add(add(scale(v, c), scale(cross(axis, v), s)), scale(axis, dot(axis, v) * (1 - c)));
}
