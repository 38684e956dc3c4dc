// SPDX-License-Identifier: Apache-2.0
// The scene as its author wrote it: questions and small changes that leave the rest of the text alone. Pure.

const kFen = /("fen"\s*:\s*)("(?:[^"\\\n]|\\.)*"|[^\s,}\]]+)/g;  // the key and its value
const kChess = /"type"\s*:\s*"chess_position"/;

// The first chess position of a parsed scene: {fen}, or null. Its FEN is undefined where it has none.
export function findPosition(scene) {
  const position = (scene?.objects ?? []).find?.((object) => object?.type === 'chess_position');
  return position ? { fen: position.fen } : null;
}

// The text with another FEN in its first chess position, and not a character else. A text that is no JSON, as happens
// while it is being written, is taken to mean its first "fen". Null if there is no place for a FEN.
export function withFen(text, fen) {
  const scene = parsed(text);
  const position = findPosition(scene);
  if (scene !== undefined && !position) return null;
  for (const { 0: whole, 1: key, 2: value, index } of text.matchAll(kFen)) {
    if (position && parsed(value) !== position.fen) continue;
    const changed = text.slice(0, index) + key + JSON.stringify(fen) + text.slice(index + whole.length);
    if (!position || findPosition(parsed(changed))?.fen === fen) return changed;
  }
  if (!position || position.fen !== undefined || !kChess.test(text)) return null;
  return text.replace(kChess, (type) => `${type}, "fen": ${JSON.stringify(fen)}`);
}

// A FEN whose fields or ranks stand on several lines, on one.
export function inOneLine(fen) {
  return String(fen).replace(/\/[\r\n]+/g, '/').replace(/[\r\n]+/g, ' ');
}

// Whether two scene texts ask for the same camera, so that an edit may keep the user's own.
export function sameCamera(textA, textB) {
  const [a, b] = [parsed(textA), parsed(textB)];
  return a !== undefined && b !== undefined && JSON.stringify(a?.camera ?? null) === JSON.stringify(b?.camera ?? null);
}

// What a scene's text says under `render`; nothing of a text that is no scene.
export function renderOf(text) {
  const render = parsed(text)?.render;
  return typeof render === 'object' && render !== null ? render : {};
}

// Offset of (line, column), both from 1, in the text; its end if there is no such place.
export function offsetOf(text, line, column) {
  let start = 0;
  for (let at = 1; at < line; ++at) {
    const next = text.indexOf('\n', start);
    if (next < 0) return text.length;
    start = next + 1;
  }
  const end = text.indexOf('\n', start);
  return Math.min(start + Math.max(0, (column ?? 1) - 1), end < 0 ? text.length : end);
}

// End of the JSON token that begins at `start`, for marking it.
export function tokenEnd(text, start) {
  const match = /^(?:"(?:[^"\\\n]|\\.)*"?|[-+.\w]+|[^\s])/.exec(text.slice(start, start + 400));
  return start + (match ? match[0].length : 0);
}

// Undefined if the text is no JSON.
function parsed(text) {
  try {
    return JSON.parse(text);
  } catch {
    return undefined;
  }
}
