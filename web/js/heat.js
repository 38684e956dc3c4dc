// SPDX-License-Identifier: Apache-2.0
// The error by pixel in false colours over the picture, with its key. It follows the picture while it refines and makes
// way while it moves; switched off, nothing is asked for.
import { byId, el } from './dom.js';

// As renderer/film/heat_map.cpp has them: sRGB from dark to bright over equal parts of a logarithmic scale.
export const kRamp = [[0, 0, 0.02], [0.26, 0.07, 0.45], [0.70, 0.16, 0.36], [0.94, 0.42, 0.16], [0.99, 0.75, 0.20], [1, 1, 0.78]];
export const kDarkest = 0.25 / 255;
export const kBrightest = 64 / 255;
const kMarks = [0.001, 0.004, 0.016, 0.06, 0.25];  // near 1/4, 1, 4, 16 and 64 steps of 8 bits

// Where on the scale an error stands, 0 to 1.
export function placeOnScale(error) {
  return Math.min(1, Math.max(0, Math.log2(error / kDarkest) / Math.log2(kBrightest / kDarkest)));
}

export class HeatLayer {
  #canvas = byId('heat');
  #legend = byId('heat-legend');
  #toggle = byId('heat-toggle');
  #load;
  #wanted = null;  // the newest frame on show; null while it moves or nothing is known of its error
  #shown = null;   // the map on show
  #isLoading = false;

  // `load(frame)` gives {viewSeq, number, blob}, the map of that frame or of a newer one, or null.
  constructor({ load }) {
    this.#load = load;
    this.#toggle.addEventListener('change', () => this.#refresh());
    this.#legend.querySelector('.heat-strip').style.background = `linear-gradient(90deg, ${kRamp.map(cssColor).join(', ')})`;
    this.#legend.querySelector('.heat-marks').replaceChildren(...kMarks.map(mark));
  }

  toggle() {
    this.#toggle.click();
  }

  follow(frame, moving) {
    this.#wanted = moving || frame.rmse === null ? null : frame;
    this.#refresh();
  }

  async #refresh() {
    this.#present();
    if (this.#isLoading) return;
    this.#isLoading = true;
    try {
      while (this.#toggle.checked && this.#wanted && !this.#isShown(this.#wanted)) {
        const asked = this.#wanted;
        const map = await this.#load(asked);
        if (map && map.viewSeq === this.#wanted?.viewSeq) await this.#draw(map);
        else if (asked === this.#wanted) break;  // gone by, or a failure: the next frame tries again
      }
    } finally {
      this.#isLoading = false;
    }
  }

  #isShown({ viewSeq, number }) {
    return this.#shown?.viewSeq === viewSeq && this.#shown.number >= number;
  }

  async #draw({ viewSeq, number, blob }) {
    const bitmap = await createImageBitmap(blob);
    this.#canvas.width = bitmap.width;
    this.#canvas.height = bitmap.height;
    this.#canvas.getContext('2d', { alpha: false }).drawImage(bitmap, 0, 0);
    bitmap.close();
    this.#shown = { viewSeq, number };
    this.#present();
  }

  // A map stays while the next pass of the same view is on its way.
  #present() {
    const isOn = this.#toggle.checked;
    const isCurrent = this.#shown !== null && this.#shown.viewSeq === this.#wanted?.viewSeq;
    this.#canvas.hidden = !isOn || !isCurrent;
    this.#legend.hidden = !isOn;
    this.#legend.classList.toggle('is-waiting', !isCurrent);
  }
}

function cssColor(rgb) {
  return `rgb(${rgb.map((c) => Math.round(c * 255)).join(' ')})`;
}

function mark(error) {
  const element = el('li', {}, String(error));
  element.style.left = `${100 * placeOnScale(error)}%`;
  return element;
}
