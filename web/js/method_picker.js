// SPDX-License-Identifier: Apache-2.0
// The choice of what draws the picture, under what the scene says; and a way to take a line drawing along as lines.
import { byId } from './dom.js';
import { kNoWords, methodName, methodNote, methodOf, wishWith } from './methods.js';
import { WordSelects } from './word_select.js';

const kLines = 'roberts';  // the method whose pictures can be had as lines

export class MethodPicker {
  #selects;
  #words = kNoWords;
  #render = {};
  #wish = {};

  // `changed(wish)` is called with every new choice, `saveLines()` when the lines are asked for.
  constructor({ changed, saveLines }) {
    const selects = { algorithm: byId('method-algorithm'), shading: byId('method-shading') };
    this.#selects = new WordSelects(selects, (key, word) => changed(wishWith(this.#wish, key, word, this.#own)));
    byId('lines-button').addEventListener('click', saveLines);
  }

  // `words` as of wordsOf(): what can be chosen.
  setWords(words) {
    this.#words = words;
    this.#selects.offer(words);
    byId('method-fields').hidden = words.algorithm.words.length === 0;
    this.show(this.#render, this.#wish);
  }

  // `render` of the scene on show, and the wish over it.
  show(render, wish) {
    this.#render = render;
    this.#wish = wish;
    const method = methodOf(render, wish, this.#words);
    this.#selects.show(method);
    byId('method-note').textContent = methodNote(method);
    const isOwn = Object.keys(wish).length === 0;
    byId('method-own').textContent = isOwn ? '' : `The scene itself asks for ${methodName(this.#own)}.`;
    byId('lines-button').hidden = method.algorithm !== kLines || !this.#words.algorithm.words.includes(kLines);
  }

  get #own() {
    return methodOf(this.#render, {}, this.#words);
  }
}
