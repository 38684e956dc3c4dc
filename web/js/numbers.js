// SPDX-License-Identifier: Apache-2.0
// Numbers as a reader wants them. Pure.

// An error, 1 being the whole way from black to white: two digits.
export function errorText(rmse) {
  return String(Number(rmse.toPrecision(2)));
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
