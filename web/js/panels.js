// SPDX-License-Identifier: Apache-2.0
// Panels that float over the picture: a button opens one, Escape or its cross closes it and gives the focus back.
import { byId } from './dom.js';

const kNarrow = matchMedia('(max-width: 720px)');

export class Panels {
  #entries;

  // `groups`: arrays of {button, panel} ids; of a group only one is open at a time, and on a phone only one at all.
  constructor(groups) {
    this.#entries = groups.flatMap((group, index) =>
      group.map(({ button, panel }) => ({ button: byId(button), panel: byId(panel), group: index })));
    for (const entry of this.#entries) {
      entry.button.addEventListener('click', () => (entry.panel.hidden ? this.#open(entry) : this.#close(entry)));
      entry.panel.querySelector('[data-close]').addEventListener('click', () => this.#close(entry));
      entry.panel.addEventListener('keydown', (event) => {
        if (event.key === 'Escape') this.#close(entry);
      });
    }
  }

  close(panelId) {
    const entry = this.#entries.find(({ panel }) => panel.id === panelId);
    if (!entry.panel.hidden) this.#close(entry);
  }

  #open(entry) {
    for (const other of this.#entries) {
      if (other !== entry && (kNarrow.matches || other.group === entry.group)) this.#hide(other);
    }
    entry.panel.hidden = false;
    entry.button.setAttribute('aria-expanded', 'true');
    entry.panel.dispatchEvent(new CustomEvent('panel-open'));
    entry.panel.querySelector('h2').focus({ preventScroll: true });
  }

  #close(entry) {
    this.#hide(entry);
    entry.button.focus();
  }

  #hide(entry) {
    entry.panel.hidden = true;
    entry.button.setAttribute('aria-expanded', 'false');
  }
}
