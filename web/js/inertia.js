// SPDX-License-Identifier: Apache-2.0
// Movement that was asked for and not yet made. Every step gives out a part of what is left, so a camera starts and stops
// softly; the parts add up to exactly what was asked.

export const kSettleMs = 70;  // time in which about 63 % of what is left is given out; a flick ends in under half a second
const kStill = 1e-4;          // radians, picture heights, log of zoom: under a tenth of a pixel

const zero = () => ({ azimuth: 0, polar: 0, panX: 0, panY: 0, zoomLog: 0 });

export class Inertia {
  #left = zero();
  #settleMs;

  // settleMs = 0 moves at once, for those who asked for less motion.
  constructor(settleMs = kSettleMs) {
    this.#settleMs = settleMs;
  }

  push(part) {
    for (const key of Object.keys(part)) this.#left[key] += part[key];
  }

  stop() {
    this.#left = zero();
  }

  get isMoving() {
    return Object.values(this.#left).some((x) => x !== 0);
  }

  // What to move in the next `elapsedMs`.
  take(elapsedMs) {
    const share = this.#settleMs > 0 ? 1 - Math.exp(-elapsedMs / this.#settleMs) : 1;
    const last = Object.values(this.#left).every((x) => Math.abs(x) * (1 - share) < kStill);
    const part = zero();
    for (const key of Object.keys(part)) {
      part[key] = last ? this.#left[key] : this.#left[key] * share;
      this.#left[key] -= part[key];
    }
    return part;
  }
}
