// SPDX-License-Identifier: Apache-2.0
// Copying, with a word that it was done. Where the browser forbids the clipboard, as on plain http, the text is shown
// for copying by hand.
import { byId } from './dom.js';
import { say } from './toast.js';

export async function copy(text, what) {
  try {
    await navigator.clipboard.writeText(text);
    say(`${what} copied`);
  } catch {
    const dialog = byId('copy-dialog');
    const area = byId('copy-text');
    area.value = text;
    byId('copy-heading').textContent = `${what}: copy it from here`;
    byId('copy-done').onclick = () => dialog.close();
    dialog.showModal();
    area.select();
  }
}
