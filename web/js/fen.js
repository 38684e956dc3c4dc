// SPDX-License-Identifier: Apache-2.0
// The field for a chess position in Forsyth-Edwards Notation, line ends that were pasted included. The server is the
// judge; its verdict stands below.
import { byId } from './dom.js';

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
  }

  // `position` = {fen} of the scene on show, or null if it has no chess board. What is being typed in stays as it is.
  show(position) {
    this.#field.hidden = !position;
    if (position && document.activeElement !== this.#input) this.#input.value = position.fen ?? '';
    this.showError();
  }

  // `error` as the server tells it, {detail, hint}; none if the position is good.
  showError(error = null) {
    this.#input.setAttribute('aria-invalid', String(Boolean(error)));
    this.#error.textContent = error ? [error.detail, error.hint].filter(Boolean).join(' ') : '';
  }
}
