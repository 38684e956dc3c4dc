// SPDX-License-Identifier: Apache-2.0
// The field for a chess position in Forsyth-Edwards Notation. The server is the judge; its verdict stands below.
import { byId } from './dom.js';
import { inOneLine } from './scene_text.js';

const kTypingMs = 300;

export class FenField {
  #field = byId('fen-field');
  #input = byId('fen');
  #error = byId('fen-error');

  // `edited(fen)` is called when typing rests.
  constructor({ edited }) {
    let timer = 0;
    this.#input.addEventListener('input', () => {
      clearTimeout(timer);
      timer = setTimeout(() => edited(this.#input.value), kTypingMs);
    });
    // By itself a field of one line drops line ends, and what they keep apart would run together.
    this.#input.addEventListener('paste', (event) => {
      const text = event.clipboardData.getData('text/plain');
      if (inOneLine(text) === text) return;
      event.preventDefault();
      document.execCommand('insertText', false, inOneLine(text));  // as a paste, it can be undone
    });
  }

  // `position` = {fen} of the scene on show, or null if it has no chess board. What is being typed in stays as it is.
  show(position) {
    this.#field.hidden = !position;
    if (position && document.activeElement !== this.#input) this.#input.value = inOneLine(position.fen ?? '');
    this.showError();
  }

  // `error` as the server tells it, {detail, hint}; none if the position is good.
  showError(error = null) {
    this.#input.setAttribute('aria-invalid', String(Boolean(error)));
    this.#error.textContent = error ? [error.detail, error.hint].filter(Boolean).join(' ') : '';
  }
}
