// SPDX-License-Identifier: Apache-2.0
// Comparing two methods on the view at rest: their choice, how far their pictures are apart, and what each took.
import { Comparison } from './compare.js';
import { CompareView } from './compare_view.js';
import { byId, el } from './dom.js';
import { kNoWords, knownWish, methodOf } from './methods.js';
import { countText, duration, errorText, ratioText, samplesText, shareText, stepsText } from './numbers.js';
import { comparableSamples } from './rules.js';
import { WordSelects } from './word_select.js';

const kSides = ['a', 'b'];
const kFirst = [{ algorithm: 'raytrace', shading: 'phong' }, { algorithm: 'zbuffer', shading: 'gouraud' }];
const kUnrest = 'Once the picture rests…';
const kHindered = { busy: 'The server is busy. The pictures come in a moment.', offline: 'The server cannot be reached. Trying again…' };

export class ComparePanel {
  #toggle = byId('compare-toggle');
  #view = new CompareView();
  #comparison;
  #still;
  #selects;
  #words = kNoWords;
  #methods = kFirst;
  #isAtRest = false;
  #order = null;     // of the pictures on show
  #points = [null, null];

  // `still()` gives {text, camera, image, render} of the view on show, `render` being the rules in force.
  constructor({ api, still }) {
    this.#still = still;
    this.#comparison = new Comparison({ api, on: {
      begin: (order) => this.#begin(order),
      side: (side, outcome) => this.#take(side, outcome),
      hindered: (side, hindrance) => this.#wait(side, kHindered[hindrance]),
      end: () => this.#conclude(),
    } });
    this.#selects = kSides.map((name, side) => new WordSelects(
      { algorithm: byId(`compare-algorithm-${name}`), shading: byId(`compare-shading-${name}`) },
      (key, word) => this.#choose(side, key, word)));
    this.#toggle.addEventListener('change', () => this.#switch());
    for (const radio of document.querySelectorAll('[name=compare-mode], [name=compare-gain]')) {
      radio.addEventListener('change', () => this.#look());
    }
    addEventListener('pagehide', () => this.#comparison.stop());
  }

  // `words` as of wordsOf(). Without any there is nothing to compare.
  setWords(words) {
    this.#words = words;
    this.#methods = kFirst.map((method) => methodOf({}, knownWish(method, words), words));
    byId('compare-box').hidden = words.algorithm.words.length === 0;
    for (const selects of this.#selects) selects.offer(words);
    this.#name();
  }

  toggle() {
    if (this.#words.algorithm.words.length > 0) this.#toggle.click();
  }

  // The picture on show moves, or is not yet whole: a comparison would take its time from it.
  hold({ isMoved = false } = {}) {
    this.#isAtRest = false;
    if (isMoved) this.#view.setCurrent(false);
    if (!this.#toggle.checked) return;
    this.#comparison.stop();
    this.#say(kUnrest);
  }

  // The picture on show is whole.
  rest() {
    this.#isAtRest = true;
    this.#ask();
  }

  #switch() {
    const isOn = this.#toggle.checked;
    byId('compare-body').hidden = !isOn;
    this.#view.setShown(isOn);
    if (isOn) this.#ask();
    else this.#comparison.stop();
  }

  #choose(side, key, word) {
    this.#methods = this.#methods.map((method, at) => (at === side ? { ...method, [key]: word } : method));
    this.#name();
    this.#ask();
  }

  #ask() {
    if (!this.#toggle.checked) return;
    if (!this.#isAtRest) {
      this.#say(kUnrest);
      return;
    }
    const { text, camera, image, render } = this.#still();
    const order = { text, camera, image, samples: comparableSamples(render), methods: this.#methods };
    if (this.#comparison.want(order)) this.#conclude();
    this.#view.setCurrent(true);
  }

  #begin(order) {
    this.#order = order;
    this.#points = [null, null];
    this.#view.clear();
    for (const name of kSides) byId(`compare-error-${name}`).textContent = '';
    this.#tell(null);
    this.#fillTable();
    this.#wait(0, 'Drawing A…');
    this.#view.setWord(1, '…');
  }

  #wait(side, sentence) {
    this.#say(sentence);
    this.#view.setWord(side, 'drawing…');
  }

  async #take(side, { blob, report, error }) {
    byId(`compare-error-${kSides[side]}`).textContent = error?.message ?? '';
    this.#view.setWord(side, error ? 'not drawn' : '');
    this.#points[side] = report?.points.at(-1) ?? null;
    this.#fillTable();
    if (side === 0) this.#wait(1, 'Drawing B…');
    if (!blob) return;
    const order = this.#order;
    const bitmap = await createImageBitmap(blob);
    if (order !== this.#order) return bitmap.close();
    this.#view.setPicture(side, bitmap);
    this.#tell(this.#view.difference);
  }

  #conclude() {
    const isWhole = this.#points.every(Boolean);
    this.#say(isWhole ? `Drawn with ${samplesText(this.#order.samples)} a pixel each.` : 'There is nothing to compare.');
  }

  #look() {
    const isDifference = chosen('compare-mode') === 'difference';
    byId('compare-gains').hidden = !isDifference;
    this.#view.setGain(isDifference ? Number(chosen('compare-gain')) : null);
  }

  #name() {
    this.#methods.forEach((method, side) => this.#selects[side].show(method));
    this.#view.setMethods(this.#methods);
  }

  #say(sentence) {
    const state = byId('compare-state');
    if (state.textContent !== sentence) state.textContent = sentence;  // spoken once
  }

  #tell(difference) {
    const { pixels, differing, rms, largest } = difference ?? {};
    byId('compare-differing').textContent = difference ? shareText(differing, pixels) : '–';
    byId('compare-pixels').textContent = difference ? `${countText(differing)} pixels` : 'of the pixels';
    byId('compare-rms').textContent = difference ? errorText(rms) : '–';
    byId('compare-rms-steps').textContent = difference ? stepsText(rms) : 'in the mean';
    byId('compare-largest').textContent = difference ? errorText(largest) : '–';
    byId('compare-largest-steps').textContent = difference ? stepsText(largest) : 'of any channel';
  }

  #fillTable() {
    const [a, b] = this.#points;
    const row = (name, value, text) => el('tr', {}, el('th', { scope: 'row' }, name),
      ...[a, b].map((point) => el('td', {}, point ? text(value(point)) : '–')),
      el('td', {}, a && b ? ratioText(value(a), value(b)) : '–'));
    byId('compare-rows').replaceChildren(
      row('Time', (point) => point.elapsed_ms, duration),
      row('Samples', ({ rays }) => rays.primary, countText),
      row('Shadow rays', ({ rays }) => rays.shadow, countText),
      row('Reflected and refracted rays', ({ rays }) => rays.reflected + rays.refracted, countText));
  }
}

function chosen(name) {
  return document.querySelector(`[name=${name}]:checked`).value;
}
