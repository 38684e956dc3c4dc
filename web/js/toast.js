// SPDX-License-Identifier: Apache-2.0
// One short sentence at the foot of the picture, which goes by itself and is read out once.
import { byId, icon } from './dom.js';

const kShownMs = 3200;
let timer = 0;

export function say(sentence, iconName = 'check') {
  const toast = byId('toast');
  toast.replaceChildren(icon(iconName), sentence);
  toast.classList.add('is-shown');
  clearTimeout(timer);
  timer = setTimeout(() => toast.classList.remove('is-shown'), kShownMs);
}
