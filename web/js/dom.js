// SPDX-License-Identifier: Apache-2.0
// Making elements. What comes from outside enters as text, never as markup.

const kGlanceMs = 500;

export const byId = (id) => document.getElementById(id);

// el('p', {class: 'x', hidden: false}, 'text', child): strings become text nodes; an attribute of null or false is left out.
export function el(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    element.setAttribute(name, value === true ? '' : value);
  }
  element.append(...children);
  return element;
}

// Calls `act()` whenever the screen has another number of pixels for one of CSS: the page went to another screen, or the
// browser zoomed. A query tells only that its own ratio is no more, so each change needs a new one. Chromium fires no
// event where the ratio is emulated (device mode of its developer tools, automated browsers), so the ratio is also read
// twice a second: a comparison of two numbers.
export function watchPixelRatio(act) {
  let known = devicePixelRatio;
  const look = () => {
    if (devicePixelRatio === known) return;
    known = devicePixelRatio;
    act();
  };
  const listen = () => matchMedia(`(resolution: ${devicePixelRatio}dppx)`).addEventListener('change', () => {
    listen();
    look();
  }, { once: true });
  listen();
  setInterval(look, kGlanceMs);
}

export function icon(name) {
  const kSvg = 'http://www.w3.org/2000/svg';
  const svg = document.createElementNS(kSvg, 'svg');
  svg.setAttribute('class', 'icon');
  svg.setAttribute('aria-hidden', 'true');
  const use = document.createElementNS(kSvg, 'use');
  use.setAttribute('href', `#icon-${name}`);
  svg.append(use);
  return svg;
}
