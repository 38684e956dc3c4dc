// SPDX-License-Identifier: Apache-2.0
// Where a divider stands: its share of the picture's width, 0 at the left edge, and how keys and pointers move it. Pure.

const kStep = 0.01;
const kLeap = 0.1;
const kMoves = { ArrowRight: kStep, ArrowUp: kStep, ArrowLeft: -kStep, ArrowDown: -kStep, PageUp: kLeap, PageDown: -kLeap };
const kEnds = { Home: 0, End: 1 };

const clamp = (x) => Math.min(1, Math.max(0, x));

// The share under a pointer at `x`, of a picture that begins at `left` and is `width` wide; `grabbed` is how far from
// the divider the pointer took hold of it.
export function shareAt(x, { left, width }, grabbed = 0) {
  return clamp((x - grabbed - left) / width);
}

// The share after a key press, or null if the key means nothing here. Whole percents stay whole.
export function shareAfterKey(share, key, isShifted = false) {
  if (key in kEnds) return kEnds[key];
  if (!(key in kMoves)) return null;
  const move = isShifted ? Math.sign(kMoves[key]) * kLeap : kMoves[key];
  return clamp(Math.round((share + move) * 1000) / 1000);
}

// How many columns of a picture stand to the left of the divider.
export function columnsLeft(share, width) {
  return Math.round(share * width);
}
