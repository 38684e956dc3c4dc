// SPDX-License-Identifier: Apache-2.0
// Numbers as a reader wants them. Pure.

const kSteps = 255;  // of 8 bits
const kCount = new Intl.NumberFormat('en');

// An error, 1 being the whole way from black to white: two digits.
export function errorText(rmse) {
  return String(Number(rmse.toPrecision(2)));
}

// The same in the steps of an 8-bit picture.
export function stepsText(error) {
  const steps = error * kSteps;
  return steps > 0 && steps < 0.095 ? 'under 0.1 of 255 steps' : `${Number(steps.toPrecision(2))} of 255 steps`;
}

// A share of a whole: exact at both ends, so that only nothing is 0 % and only all is 100 %.
export function shareText(part, whole) {
  const percent = whole === 0 ? 0 : (100 * part) / whole;
  if (percent > 0 && percent < 0.01) return 'under 0.01 %';
  if (percent > 99.9 && percent < 100) return 'over 99.9 %';
  return `${Number(percent.toFixed(percent < 1 ? 2 : 1))} %`;
}

// How many times as much `b` is as `a`.
export function ratioText(a, b) {
  if (!(a > 0) || !Number.isFinite(b)) return '–';
  const ratio = b / a;
  return `× ${ratio >= 100 ? Math.round(ratio) : Number(ratio.toPrecision(2))}`;
}

export function countText(n) {
  return kCount.format(n);
}

// Samples a pixel: whole, or in the mean over pixels to a tenth.
export function samplesNumber(spp) {
  return String(Number(spp.toFixed(spp < 100 ? 1 : 0)));
}

export function samplesText(spp) {
  const number = samplesNumber(spp);
  return number === '1' ? '1 sample' : `${number} samples`;
}

export function duration(ms) {
  if (ms === undefined) return null;
  if (ms >= 1000) return `${(ms / 1000).toFixed(1)} s`;
  return ms >= 1 ? `${Math.round(ms)} ms` : `${Math.round(ms * 1000)} µs`;
}

// A duration that somebody chose, without digits that say nothing: 2 s, 0.5 s.
export function chosenDuration(ms) {
  return ms < 100 ? `${Number(ms.toPrecision(3))} ms` : `${Number((ms / 1000).toPrecision(4))} s`;
}
