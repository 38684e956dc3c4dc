// SPDX-License-Identifier: Apache-2.0
// The canvas that fills the window. It keeps the last picture until the next one is decoded, and never goes back to an
// older view.

export class Picture {
  #canvas;
  #context;
  #bitmap = null;
  #shown = { viewSeq: 0, number: 0 };

  constructor(canvas) {
    this.#canvas = canvas;
    this.#context = canvas.getContext('2d', { alpha: false });
  }

  // `size` = the pixels of a full picture in the window.
  resize(size) {
    this.#canvas.width = size.width;
    this.#canvas.height = size.height;
    this.#draw();
  }

  // Returns the picture's own size, or null if a newer one was faster.
  async show(frame) {
    const bitmap = await createImageBitmap(frame.blob);
    const { viewSeq, number } = this.#shown;
    const isOld = frame.viewSeq < viewSeq || (frame.viewSeq === viewSeq && frame.number < number);
    if (isOld) {
      bitmap.close();
      return null;
    }
    this.#bitmap?.close();
    this.#bitmap = bitmap;
    this.#shown = { viewSeq: frame.viewSeq, number: frame.number };
    this.#draw();
    return { width: bitmap.width, height: bitmap.height };
  }

  // Fills the canvas; a picture of another shape, as while the window is being resized, is cropped and not squeezed.
  #draw() {
    if (!this.#bitmap) return;
    const { width, height } = this.#canvas;
    const ratio = Math.max(width / this.#bitmap.width, height / this.#bitmap.height);
    const w = this.#bitmap.width * ratio;
    const h = this.#bitmap.height * ratio;
    this.#context.drawImage(this.#bitmap, (width - w) / 2, (height - h) / 2, w, h);
  }
}
