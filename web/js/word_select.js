// SPDX-License-Identifier: Apache-2.0
// Select boxes for the words of a method: one for the algorithm, one for the shading.
import { el } from './dom.js';
import { kMethodKeys, nameOf } from './methods.js';

export class WordSelects {
  #selects;

  // `selects` = {algorithm, shading}; `changed(key, word)` is called with every choice.
  constructor(selects, changed) {
    this.#selects = selects;
    for (const key of kMethodKeys) selects[key].addEventListener('change', () => changed(key, selects[key].value));
  }

  // `words` as of wordsOf().
  offer(words) {
    for (const key of kMethodKeys) {
      this.#selects[key].replaceChildren(...words[key].words.map((word) => el('option', { value: word }, nameOf(word))));
    }
  }

  show(method) {
    for (const key of kMethodKeys) this.#selects[key].value = method[key];
  }
}
