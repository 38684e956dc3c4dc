// SPDX-License-Identifier: Apache-2.0
// How far the picture is, calmly: a ring that fills, samples of how many, size and time, and why it is finished. And what
// stands in the way, when something does.
import { byId } from './dom.js';
import { duration, errorText, samplesNumber, samplesText } from './numbers.js';
import { endOf, progressOf, samplesAsked } from './rules.js';

const kHintMs = 9000;
const kAlmost = 0.99;  // what no frame but the last one exceeds

export class Status {
  #render = {};  // the rules in force
  #since = performance.now();

  expect(render = {}) {
    this.#render = render;
    this.#since = performance.now();
  }

  restart() {
    this.#since = performance.now();
  }

  // The same picture from the first sample on, under other rules.
  again() {
    this.restart();
    this.#set(0, 'Starting again', [], '');
  }

  show({ frame, size, moving }) {
    byId('cover').classList.add('is-gone');
    const pixels = `${size.width} × ${size.height}`;
    if (moving) {
      this.#since = performance.now();
      this.#set(0, 'Preview', [], pixels);
      byId('spoken').textContent = '';  // so that the same words are said again
      return;
    }
    if (!frame.isFinal) {
      this.#set(Math.min(kAlmost, progressOf(frame, this.#render)), this.#progress(frame), [], pixels);
      return;
    }
    const main = endOf(frame, this.#render);
    const samples = samplesText(frame.spp);
    const took = duration(performance.now() - this.#since);
    const error = frame.rmse === null ? [] : [`error ${errorText(frame.rmse)}`];
    const more = { rmse: [samples, took], time: [...error, samples] }[frame.stop] ?? [took];
    this.#set(1, main, more, pixels);
    byId('spoken').textContent = `The picture is done: ${main}.`;
  }

  #progress({ spp, rmse }) {
    const total = samplesAsked(this.#render);
    if (total) return `${samplesNumber(spp)} of ${samplesText(total)}`;
    if (this.#render.rmse && rmse !== null) return `Error ${errorText(rmse)}, ${errorText(this.#render.rmse)} asked`;
    return samplesText(spp);
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
    if (!cover.classList.contains('is-gone')) this.#set(0, 'No picture', [], '');
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

  #set(share, main, more, pixels) {
    const ring = byId('progress');
    const percent = Math.round(share * 100);
    ring.style.setProperty('--share', `${percent}%`);
    ring.classList.toggle('is-full', percent === 100);
    ring.setAttribute('aria-valuenow', String(percent));
    ring.setAttribute('aria-valuetext', main);
    byId('status-main').textContent = main;
    byId('status-more').textContent = more.join(' · ');
    byId('status-size').textContent = pixels;
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
