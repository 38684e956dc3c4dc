// SPDX-License-Identifier: Apache-2.0
// The scene as its author wrote it: questions and small changes that leave the rest of the text alone. Pure.

const kString = '"(?:[^"\\\\\\n]|\\\\.)*"';  // a JSON string, as a pattern

// The first chess position of a parsed scene: {fen, index}, or null.
export function findPosition(scene) {
  const index = (scene?.objects ?? []).findIndex?.((object) => object?.type === 'chess_position') ?? -1;
  return index < 0 ? null : { fen: scene.objects[index].fen ?? '', index };
}

// The text with another FEN in its first chess position, in place where the old one can be found. A text that is no
// JSON, as happens while it is being written, is taken to mean its first "fen". Null if there is no place for a FEN.
export function withFen(text, fen) {
  const scene = parsed(text);
  const position = findPosition(scene);
  if (scene !== undefined && !position) return null;
  const old = position ? escapeForPattern(JSON.stringify(position.fen)) : kString;
  const place = new RegExp(`("fen"\\s*:\\s*)${old}`);
  if (place.test(text)) return text.replace(place, (_, key) => key + JSON.stringify(fen));
  if (!position) return null;
  scene.objects[position.index].fen = fen;
  return `${JSON.stringify(scene, null, 2)}\n`;
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

function escapeForPattern(text) {
  return text.replace(/[.*+?^${}()|[\]\\/]/g, '\\$&');
}
