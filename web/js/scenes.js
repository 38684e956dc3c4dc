// SPDX-License-Identifier: Apache-2.0
// The scene picker: one button a scene, with a small picture that the server draws when the list is first opened.
import { el, icon } from './dom.js';

const kThumbnail = { width: 160, height: 90 };
const kThumbnailSamples = 4;

export class ScenePicker {
  #api;
  #buttons = new Map();  // file -> button

  // `pick(scene)` gets the chosen {file, title, description}.
  constructor({ api, list, scenes, pick }) {
    this.#api = api;
    list.replaceChildren(...scenes.map((scene) => {
      const button = el('button', { class: 'scene' },
        el('span', { class: 'scene-thumb' }, icon('mark')),
        el('span', { class: 'scene-words' },
          el('span', { class: 'scene-title' }, scene.title),
          el('span', { class: 'scene-description' }, scene.description)));
      button.addEventListener('click', () => pick(scene));
      this.#buttons.set(scene.file, button);
      return el('li', {}, button);
    }));
  }

  // `file` = null when the scene on show is nobody's but the user's.
  mark(file) {
    for (const [name, button] of this.#buttons) {
      if (name === file) button.setAttribute('aria-current', 'true');
      else button.removeAttribute('aria-current');
    }
  }

  // One after the other, so that the picture on show is not kept waiting. A scene that fails keeps its blank.
  async drawThumbnails() {
    for (const [file, button] of this.#buttons) {
      const place = button.querySelector('.scene-thumb');
      if (place.querySelector('img')) continue;
      try {
        const scene = JSON.parse(await this.#api.loadScene(file));
        scene.image = { ...scene.image, ...kThumbnail };
        scene.render = { ...scene.render, samples: kThumbnailSamples };
        const url = URL.createObjectURL(await this.#api.renderImage(scene, 'image/jpeg'));
        place.replaceChildren(el('img', { src: url, alt: '', ...kThumbnail }));
      } catch {
        continue;
      }
    }
  }
}
