// SPDX-License-Identifier: Apache-2.0
// Draws one view by two methods, one after the other, so that neither takes time from the other. The newest order wins:
// the one before it is called off, and nothing that it still brings is told. A busy or absent server is waited for.
import { hindranceOf, waitOut } from './patience.js';
import { rulePatch } from './rules.js';

export class Comparison {
  #api;
  #on;
  #key = null;            // the newest order, if it is under way or done
  #wanted = null;         // the newest order, until it begins
  #turn = new AbortController();
  #isBusy = false;
  #stored = { text: null, id: null };

  // `on.begin(order)`, then for either side 0 and 1 `on.side(side, {blob, report} or {error})`, and `on.end()`;
  // `on.hindered(side, hindrance)` where a side has to wait, as of hindranceOf().
  constructor({ api, on }) {
    this.#api = api;
    this.#on = on;
  }

  // `order` = {text, camera, image, samples, methods: [a, b]}. One that is under way or done is not drawn again. Returns
  // whether it is done.
  want(order) {
    const key = JSON.stringify(order);
    if (key === this.#key) return !this.#isBusy;
    this.#turn.abort();
    this.#key = key;
    this.#wanted = order;
    if (!this.#isBusy) this.#work();
    return false;
  }

  // Calls off what is not done.
  stop() {
    this.#wanted = null;
    if (!this.#isBusy) return;
    this.#key = null;
    this.#turn.abort();
  }

  async #work() {
    this.#isBusy = true;
    while (this.#wanted) {
      const order = this.#wanted;
      this.#wanted = null;
      this.#turn = new AbortController();
      await this.#drawBoth(order, this.#turn.signal);
    }
    this.#isBusy = false;
  }

  async #drawBoth(order, signal) {
    this.#on.begin(order);
    for (const side of [0, 1]) {
      const outcome = await this.#draw(order, side, signal);
      if (signal.aborted) return;
      if (outcome.error) this.#key = null;  // who asks again, gets another try
      this.#on.side(side, outcome);
    }
    this.#on.end();
  }

  // {blob, report} of a side, or the {error} that waiting does not mend.
  async #draw(order, side, signal) {
    for (let attempt = 0; ; ++attempt) {
      try {
        const { camera, image, samples } = order;
        const render = { ...rulePatch({ key: 'samples', value: samples }), ...order.methods[side] };
        const scene = await this.#sceneId(order.text);
        return await this.#api.renderStill({ scene, camera, image, render, priority: 'normal' }, { signal });
      } catch (error) {
        if (signal.aborted) return null;
        const isForgotten = error.errors?.some(({ code }) => code === 'unknown_scene');
        if (isForgotten && attempt === 0) {
          this.#stored = { text: null, id: null };
          continue;
        }
        const hindrance = hindranceOf(error);
        if (!hindrance) return { error };
        this.#on.hindered(side, hindrance);
        await Promise.race([waitOut(error, attempt), calledOff(signal)]);
        if (signal.aborted) return null;
      }
    }
  }

  async #sceneId(text) {
    if (this.#stored.text !== text) this.#stored = { text, id: await this.#api.storeScene(text) };
    return this.#stored.id;
  }
}

function calledOff(signal) {
  return new Promise((resolve) => signal.addEventListener('abort', resolve, { once: true }));
}
