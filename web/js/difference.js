// SPDX-License-Identifier: Apache-2.0
// How far two pictures are apart, as they are displayed. Pictures are RGBA bytes of one size. Pure.

const kSteps = 255;  // of 8 bits

// {pixels, differing, rms, largest}: pixels in all and those that differ in any channel; the root mean square over
// pixels and channels and the largest difference, of displayed values from 0 to 1.
export function differenceOf(a, b) {
  let differing = 0;
  let squares = 0;  // whole numbers: exact up to 4e10 pixels
  let largest = 0;
  for (let i = 0; i < a.length; i += 4) {
    const red = Math.abs(a[i] - b[i]);
    const green = Math.abs(a[i + 1] - b[i + 1]);
    const blue = Math.abs(a[i + 2] - b[i + 2]);
    const most = Math.max(red, green, blue);
    if (most === 0) continue;
    ++differing;
    squares += red * red + green * green + blue * blue;
    if (most > largest) largest = most;
  }
  const pixels = a.length / 4;
  const rms = pixels === 0 ? 0 : Math.sqrt(squares / (3 * pixels)) / kSteps;
  return { pixels, differing, rms, largest: largest / kSteps };
}

// |a - b| by channel, `gain` times as bright, written into `out`.
export function drawDifference(a, b, gain, out) {
  for (let i = 0; i < out.length; i += 4) {
    for (let channel = i; channel < i + 3; ++channel) out[channel] = Math.min(kSteps, gain * Math.abs(a[channel] - b[channel]));
    out[i + 3] = kSteps;
  }
}
