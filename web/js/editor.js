// SPDX-License-Identifier: Apache-2.0
// A text field for the scene with line numbers and marks. Mistakes stand where they are: a dot in the gutter, the line
// tinted, the token underlined; below, each mistake in words, and a click on it leads there.
import { byId, el } from './dom.js';
import { offsetOf, tokenEnd } from './scene_text.js';

const kTypingMs = 450;  // a pause in typing after which the scene is tried

export class Editor {
  #area = byId('editor-text');
  #numbers = document.querySelector('.editor-numbers');
  #marks = document.querySelector('.editor-marks');
  #list = byId('editor-errors');
  #state = byId('editor-state');
  #lines = 0;
  #timer = 0;

  // `edited(text)` is called when typing rests.
  constructor({ edited }) {
    this.#area.addEventListener('input', () => {
      this.#changed();
      this.#timer = setTimeout(() => edited(this.#area.value), kTypingMs);
    });
    this.#area.addEventListener('scroll', () => this.#follow());
  }

  get text() {
    return this.#area.value;
  }

  // The text of a scene that is on show.
  show(text) {
    if (this.#area.value !== text) {
      this.#area.value = text;
      this.#area.setSelectionRange(0, 0);
      this.#area.scrollTo(0, 0);
    }
    this.#changed();
    this.#showErrors([]);
  }

  // The same text with a change that was made elsewhere, to be judged like one that was typed.
  amend(text) {
    this.#area.value = text;
    this.#changed();
  }

  // `errors` of `text` as the server tells them: {pointer, detail, allowed, hint, line, column}; those in `told` stand in
  // words elsewhere. A text that has changed since waits for its own judgement.
  judge(text, errors, told = []) {
    if (text === this.#area.value) this.#showErrors(errors, told);
  }

  #showErrors(errors, told = []) {
    const untold = errors.filter((error) => !told.includes(error));
    this.#area.setAttribute('aria-invalid', String(untold.length > 0));
    this.#list.hidden = untold.length === 0;
    this.#list.replaceChildren(...untold.map((error) => el('li', {}, this.#describe(error))));
    this.#marks.replaceChildren(...errors.filter(({ line }) => line).flatMap((error) => this.#mark(error)));
    this.#numbers.querySelectorAll('.dot').forEach((dot) => dot.remove());
    for (const { line } of errors) if (line) this.#numbers.append(placed('span', 'dot', line));
    this.#tell(['Drawn', '1 mistake'][errors.length] ?? `${errors.length} mistakes`, errors.length > 0);
    this.#follow();
  }

  #changed() {
    clearTimeout(this.#timer);
    this.#number();
    this.#state.classList.add('is-old');
  }

  // A screen reader speaks when these words change, so they stay while a change is judged, out of sight.
  #tell(words, isBad) {
    if (this.#state.textContent !== words) this.#state.textContent = words;
    this.#state.classList.toggle('is-bad', isBad);
    this.#state.classList.remove('is-old');
  }

  #describe(error) {
    const place = error.line ? `Line ${error.line}, column ${error.column ?? 1}` : error.pointer || 'Scene';
    const button = el('button', { class: 'error' },
      el('span', { class: 'error-place' }, place, ...(error.line && error.pointer ? [el('code', {}, error.pointer)] : [])),
      el('span', { class: 'error-detail' }, error.detail ?? ''),
      ...(error.hint ? [el('span', { class: 'error-hint' }, error.hint)] : []));
    button.addEventListener('click', () => this.#jump(error));
    return button;
  }

  #mark({ line, column }) {
    const text = this.#area.value;
    const start = offsetOf(text, line, column);
    const width = Math.max(1, tokenEnd(text, start) - start);
    const token = placed('span', 'mark-token', line);
    token.style.left = `${(column ?? 1) - 1}ch`;
    token.style.width = `${width}ch`;
    return [placed('span', 'mark-line', line), token];
  }

  #jump({ line, column }) {
    if (!line) return;
    const text = this.#area.value;
    const start = offsetOf(text, line, column);
    this.#area.focus();
    this.#area.setSelectionRange(start, tokenEnd(text, start));
    const lineHeight = parseFloat(getComputedStyle(this.#area).lineHeight);
    this.#area.scrollTop = Math.max(0, (line - 1) * lineHeight - this.#area.clientHeight / 3);
    this.#area.scrollLeft = 0;
  }

  #number() {
    const lines = this.#area.value.split('\n').length;
    if (lines === this.#lines) return;
    this.#lines = lines;
    const text = Array.from({ length: lines }, (_, i) => i + 1).join('\n');
    this.#numbers.replaceChildren(text);
  }

  #follow() {
    const { scrollTop, scrollLeft } = this.#area;
    this.#numbers.style.transform = `translateY(${-scrollTop}px)`;
    this.#marks.style.transform = `translate(${-scrollLeft}px, ${-scrollTop}px)`;
  }
}

// An element at a line's height; the style sheet knows how high a line is.
function placed(tag, name, line) {
  const element = el(tag, { class: name });
  element.style.setProperty('--line', String(line - 1));
  return element;
}
