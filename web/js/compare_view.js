// SPDX-License-Identifier: Apache-2.0
// Two pictures of one view in one place: side by side under a divider that is dragged, or their difference. It lies over
// the picture, and lets the hand through to it everywhere but on the divider.
import { drawDifference, differenceOf } from './difference.js';
import { columnsLeft, shareAfterKey, shareAt } from './divider.js';
import { byId } from './dom.js';
import { methodName, nameOf } from './methods.js';

export class CompareView {
  #layer = byId('compare');
  #canvas = byId('compare-picture');
  #context = this.#canvas.getContext('2d');
  #divider = byId('divider');
  #tags = [byId('compare-tag-a'), byId('compare-tag-b')];
  #bitmaps = [null, null];
  #names = ['', ''];  // of the methods, as they are spoken
  #gain = null;  // null: the divider
  #share = 0.5;

  constructor() {
    this.#attachPointer();
    this.#divider.addEventListener('keydown', (event) => {
      if (event.altKey || event.ctrlKey || event.metaKey) return;
      const share = shareAfterKey(this.#share, event.key, event.shiftKey);
      if (share === null) return;
      event.preventDefault();
      this.#move(share);
    });
    this.#move(this.#share);
  }

  setShown(isShown) {
    this.#layer.hidden = !isShown;
  }

  // While the camera moves, pictures of another view are out of sight.
  setCurrent(isCurrent) {
    this.#layer.classList.toggle('is-waiting', !isCurrent);
  }

  setMethods(methods) {
    this.#names = methods.map(methodName);
    methods.forEach(({ algorithm, shading }, side) => {
      this.#tags[side].querySelector('.tag-algorithm').textContent = nameOf(algorithm);
      this.#tags[side].querySelector('.tag-shading').textContent = nameOf(shading);
    });
    this.#move(this.#share);
  }

  // What is to be said of a side where its picture is not there, in a word or two.
  setWord(side, word) {
    this.#tags[side].querySelector('.tag-word').textContent = word;
  }

  // `gain`: how many times the difference is brightened; null shows the pictures themselves.
  setGain(gain) {
    this.#gain = gain;
    this.#layer.classList.toggle('is-difference', gain !== null);
    byId('compare-tag-gain').textContent = gain === null ? '' : `× ${gain}`;
    this.#draw();
  }

  clear() {
    for (const bitmap of this.#bitmaps) bitmap?.close();
    this.#bitmaps = [null, null];
    this.#draw();
  }

  setPicture(side, bitmap) {
    this.#bitmaps[side] = bitmap;
    this.#draw();
  }

  // As of differenceOf(); null while a picture is missing.
  get difference() {
    const [a, b] = this.#bitmaps;
    return a && b ? differenceOf(pixelsOf(a).data, pixelsOf(b).data) : null;
  }

  #draw() {
    const [a, b] = this.#bitmaps;
    const { width, height } = a ?? b ?? { width: 1, height: 1 };
    if (this.#canvas.width !== width || this.#canvas.height !== height) Object.assign(this.#canvas, { width, height });
    this.#context.clearRect(0, 0, width, height);
    if (this.#gain === null) this.#drawHalves(a, b, columnsLeft(this.#share, width), width, height);
    else if (a && b) this.#drawDifference(a, b);
  }

  #drawHalves(a, b, left, width, height) {
    if (a && left > 0) this.#context.drawImage(a, 0, 0, left, height, 0, 0, left, height);
    if (b && left < width) this.#context.drawImage(b, left, 0, width - left, height, left, 0, width - left, height);
  }

  #drawDifference(a, b) {
    const out = new ImageData(a.width, a.height);
    drawDifference(pixelsOf(a).data, pixelsOf(b).data, this.#gain, out.data);
    this.#context.putImageData(out, 0, 0);
  }

  #move(share) {
    this.#share = share;
    this.#layer.style.setProperty('--share', `${100 * share}%`);
    const percent = Math.round(100 * share);
    this.#divider.setAttribute('aria-valuenow', String(percent));
    this.#divider.setAttribute('aria-valuetext',
      `${percent} %: A, ${this.#names[0]}, to the left; B, ${this.#names[1]}, to the right`);
    if (this.#gain === null) this.#draw();
  }

  #attachPointer() {
    let grabbed = null;  // how far from the divider the pointer took hold
    const box = () => this.#layer.getBoundingClientRect();
    this.#divider.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return;
      this.#divider.setPointerCapture(event.pointerId);
      const { left, width } = box();
      grabbed = event.clientX - left - this.#share * width;
    });
    this.#divider.addEventListener('pointermove', (event) => {
      if (grabbed !== null) this.#move(shareAt(event.clientX, box(), grabbed));
    });
    for (const end of ['pointerup', 'pointercancel', 'lostpointercapture']) {
      this.#divider.addEventListener(end, () => { grabbed = null; });
    }
  }
}

function pixelsOf(bitmap) {
  const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d', { willReadFrequently: true });
  context.drawImage(bitmap, 0, 0);
  return context.getImageData(0, 0, bitmap.width, bitmap.height);
}
