// SPDX-License-Identifier: Apache-2.0
// What draws a picture: a hidden-surface method and a shading rule, by the words that they have in `render` of a scene.
// A wish is {algorithm, shading}; what it lacks is left to the scene. Pure.

export const kMethodKeys = ['algorithm', 'shading'];

// What the page can say of a word; which words there are is the server's to say.
const kTold = {
  raytrace: { name: 'Ray tracing', note: 'The whole light model: shadows, mirrors, glass.' },
  zbuffer: { name: 'Z-buffer', note: 'At every sample the nearest surface by depth; local light, shadows by rays.' },
  warnock: { name: 'Warnock', note: 'Quarters the picture until each part is simple; local light, shadows by rays.' },
  roberts: { name: 'Roberts', note: 'A line drawing: the edges in sight.' },
  flat: { name: 'Flat', note: 'Lit once a face.' },
  gouraud: { name: 'Gouraud', note: 'Lit at the corners, blended between them.' },
  phong: { name: 'Phong', note: 'Lit at every point.' },
};

// The words of the scene language's schema: {algorithm: {words, first}, shading: {words, first}}, `first` being what a
// scene means that says nothing.
export function wordsOf(schema) {
  const render = resolved(schema, schema.properties.render).properties;
  return Object.fromEntries(kMethodKeys.map((key) => {
    const rule = resolved(schema, render[key]);
    return [key, { words: rule.enum, first: render[key].default ?? rule.enum[0] }];
  }));
}

// As wordsOf() where the server did not say: nothing is on offer.
export const kNoWords = { algorithm: { words: [], first: 'raytrace' }, shading: { words: [], first: 'phong' } };

export function nameOf(word) {
  return kTold[word]?.name ?? word[0].toUpperCase() + word.slice(1).replaceAll('_', ' ');
}

export function methodName({ algorithm, shading }) {
  return `${nameOf(algorithm)}, ${nameOf(shading)}`;
}

export function methodNote({ algorithm, shading }) {
  return [algorithm, shading].map((word) => kTold[word]?.note).filter(Boolean).join(' ');
}

// The method in force for a scene of that `render`.
export function methodOf(render, wish, words) {
  return fromKeys((key) => wish[key] ?? render?.[key] ?? words[key].first);
}

// The wish after `word` was chosen for `key`. The scene's own word is no wish.
export function wishWith(wish, key, word, own) {
  return fromKeys((each) => (each === key ? (word === own[key] ? undefined : word) : wish[each]));
}

// The wish as far as the server knows its words.
export function knownWish(wish, words) {
  return fromKeys((key) => (words[key].words.includes(wish[key]) ? wish[key] : undefined));
}

// The wish after an edit of the scene: whoever writes another word into the scene wants that one.
export function wishAfterEdit(wish, renderBefore, renderAfter) {
  return fromKeys((key) => (renderBefore?.[key] === renderAfter?.[key] ? wish[key] : undefined));
}

function fromKeys(find) {
  return Object.fromEntries(kMethodKeys.map((key) => [key, find(key)]).filter(([, word]) => word !== undefined));
}

function resolved(schema, rule) {
  const name = /^#\/\$defs\/([^/]+)$/.exec(rule.$ref ?? '')?.[1];
  return name ? schema.$defs[name] : rule;
}
