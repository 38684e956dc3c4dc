// SPDX-License-Identifier: Apache-2.0
// How far the picture is, calmly: a ring that fills, samples of how many, size and time. And what stands in the way, when
// something does.
import { byId } from './dom.js';

const kHintMs = 9000;

export class Status {
  #total = null;  // samples a pixel that the scene asks for; null when it asks for time or an error instead
  #since = performance.now();

  expect(render = {}) {
    this.#total = render.samples ?? (render.time_ms || render.rmse ? null : 16);
    this.#since = performance.now();
  }

  restart() {
    this.#since = performance.now();
  }

  show({ frame, size, moving }) {
    byId('cover').classList.add('is-gone');
    const pixels = `${size.width} × ${size.height}`;
    if (moving) {
      this.#since = performance.now();
      this.#set(0, 'Preview', pixels);
      byId('spoken').textContent = '';  // so that the same words are said again
      return;
    }
    const share = frame.isFinal ? 1 : this.#total ? frame.spp / this.#total : 0.5;
    const samples = frame.spp === 1 ? '1 sample' : `${frame.spp} samples`;
    const main = frame.isFinal ? samples : this.#total ? `${frame.spp} of ${this.#total} samples` : samples;
    const seconds = (performance.now() - this.#since) / 1000;
    this.#set(share, main, frame.isFinal ? `${pixels} · ${formatSeconds(seconds)}` : pixels);
    if (frame.isFinal) byId('spoken').textContent = `The picture is done: ${main}.`;
  }

  // `name` as of ViewSession's states.
  state(name, problem) {
    const sentence = {
      offline: 'The server cannot be reached. Trying again…',
      busy: 'The server is busy. The picture comes in a moment.',
      failed: `This view cannot be drawn. ${problem?.message ?? ''}`,
    }[name];
    this.#notify(sentence, name === 'failed' ? 'warning' : 'offline');
  }

  // A scene that did not come: says so and offers `retry`.
  broken(sentence, retry) {
    const cover = byId('cover');
    if (!cover.classList.contains('is-gone')) this.#set(0, 'No picture', '');
    cover.classList.add('is-empty');
    this.#notify(sentence, 'warning');
    const button = byId('notice-button');
    button.hidden = false;
    button.onclick = () => {
      cover.classList.remove('is-empty');
      this.#notify();
      retry();
    };
  }

  #notify(sentence = '', iconName = 'offline') {
    byId('notice').hidden = !sentence;
    if (byId('notice-text').textContent !== sentence) byId('notice-text').textContent = sentence;  // spoken once
    byId('notice-icon').setAttribute('href', `#icon-${iconName}`);
    byId('notice-button').hidden = true;
  }

  #set(share, main, more) {
    const ring = byId('progress');
    const percent = Math.round(share * 100);
    ring.style.setProperty('--share', `${percent}%`);
    ring.classList.toggle('is-full', percent === 100);
    ring.setAttribute('aria-valuenow', String(percent));
    ring.setAttribute('aria-valuetext', main);
    byId('status-main').textContent = main;
    byId('status-more').textContent = more;
  }
}

// A word on how to move, until somebody does.
export function showHint() {
  const hint = byId('hint');
  const isTouch = matchMedia('(pointer: coarse)').matches;
  hint.textContent = isTouch ? 'One finger orbits, two move and zoom' : 'Drag to orbit · scroll to zoom · right-drag to move';
  hint.classList.add('is-shown');
  const hide = () => hint.classList.remove('is-shown');
  setTimeout(hide, kHintMs);
  return hide;
}

function formatSeconds(seconds) {
  return seconds < 1 ? `${Math.round(seconds * 1000)} ms` : `${seconds.toFixed(1)} s`;
}
