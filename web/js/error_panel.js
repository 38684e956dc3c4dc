// SPDX-License-Identifier: Apache-2.0
// The error panel: how wrong the picture on show is, in words, as a curve and pass by pass. While it is closed points
// are kept and nothing is drawn.
import { Curves } from './curves.js';
import { byId, el } from './dom.js';
import { drawErrorPlot } from './error_plot.js';
import { duration, errorText, samplesNumber, stepsText } from './numbers.js';

export class ErrorPanel {
  #panel = byId('error-panel');
  #curves = new Curves();
  #asked = {};

  constructor() {
    this.#panel.addEventListener('panel-open', () => this.#draw());
    new ResizeObserver(() => this.#draw()).observe(byId('error-plot'));
  }

  // `render` = the rules in force.
  expect(render) {
    this.#asked = render;
    this.#draw();
  }

  take(frame) {
    this.#curves.take(frame);
    this.#draw();
  }

  #draw() {
    if (this.#panel.hidden) return;
    const { current, before, newest } = this.#curves;
    if (newest) this.#tell(newest);
    drawErrorPlot(byId('error-plot'), this.#curves, this.#asked);
    byId('key-before').hidden = !before;
    byId('key-asked').hidden = !(this.#asked.rmse || this.#asked.time_ms);
    byId('error-rows').replaceChildren(...current.points.map(({ spp, rmse, ms }) => el('tr', {},
      el('td', {}, String(spp)), el('td', {}, rmse.toFixed(6)), el('td', {}, duration(ms)))));
  }

  #tell({ spp, rmse, ms }) {
    byId('error-now').textContent = rmse === null ? '–' : errorText(rmse);
    byId('error-steps').textContent = rmse === null ? 'takes two samples' : stepsText(rmse);
    byId('error-samples').textContent = samplesNumber(spp);
    byId('error-time').textContent = duration(ms) ?? '–';
  }
}
