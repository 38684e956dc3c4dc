// SPDX-License-Identifier: Apache-2.0
// The present view in a form that leaves the page: a link, or a command for a shell. Pure but for the compression, which
// the browser does.
import { kMethodKeys } from './methods.js';
import { kRules, readRule, withRule } from './rules.js';

// A scene document with the picture's present camera, size, stop rule and method.
export function stillDocument(sceneText, { camera, image, rule = null, method = {} }) {
  const scene = JSON.parse(sceneText);
  const render = { ...withRule(scene.render, rule), ...method };
  const out = { ...scene, camera, image: { ...scene.image, ...image } };
  return Object.keys(render).length > 0 ? { ...out, render } : out;
}

// A command that any POSIX shell with curl 7.76 or newer runs as it is. The scene stands in a quoted here-document, in
// which a shell changes nothing; no line of JSON can be its end mark. A picture that takes longer than a request waits
// (30 seconds) is answered with a job: tilelight.png then holds that job's JSON, as it holds the reason of a refusal.
export function curlCommand(baseUrl, document) {
  return [
    `curl --silent --show-error --fail-with-body '${baseUrl}/v1/renders' \\`,
    "  --header 'Content-Type: application/json' --header 'Accept: image/png' \\",
    "  --output tilelight.png --data-binary @- <<'SCENE'",
    JSON.stringify(document),
    'SCENE',
    '',
  ].join('\n');
}

// {scene: name} or {text: scene JSON}, {camera}, {rule} and {method}, to and from the part of a link after its #.
export async function encodeLink({ scene, text, camera, rule, method }) {
  const parts = new URLSearchParams();
  if (text) parts.set('json', toBase64Url(await deflate(text)));
  else parts.set('scene', scene);
  if (camera) parts.set('camera', cameraNumbers(camera).join(','));
  return linkWith(parts, { rule, method });
}

// A link with another rule and method, and all else as it was.
export function linkWith(hash, { rule = null, method = {} }) {
  const parts = new URLSearchParams(typeof hash === 'string' ? hash.replace(/^#/, '') : hash);
  for (const key of [...Object.keys(kRules), ...kMethodKeys]) parts.delete(key);
  if (rule) parts.set(rule.key, String(rule.value));
  for (const key of kMethodKeys) if (method[key]) parts.set(key, method[key]);
  return `#${decodeURIComponent(parts.toString())}`;
}

// Null parts where the link has none or says something odd; isDamaged when it has a text that cannot be read.
export async function decodeLink(hash) {
  const parts = new URLSearchParams(hash.replace(/^#/, ''));
  const json = parts.get('json');
  const text = json === null ? null : await inflate(fromBase64Url(json)).catch(() => null);
  return {
    scene: parts.get('scene'), text, camera: cameraFrom(parts.get('camera')), rule: ruleFrom(parts),
    method: methodFrom(parts), isDamaged: json !== null && !text,
  };
}

function ruleFrom(parts) {
  const key = Object.keys(kRules).find((name) => parts.has(name));
  return key ? readRule(key, parts.get(key), { factor: 1 }).rule ?? null : null;
}

// Whether the words mean anything is for the server's schema to say.
function methodFrom(parts) {
  return Object.fromEntries(kMethodKeys.filter((key) => parts.get(key)).map((key) => [key, parts.get(key)]));
}

function cameraNumbers(camera) {
  const angle = camera.type === 'orthographic' ? ['h', camera.height] : ['p', camera.fov_y_deg];
  const numbers = [angle[1], ...camera.position, ...camera.target, ...(camera.up ?? [0, 1, 0])];
  return [angle[0], ...numbers.map((x) => String(x).replace('e+', 'e'))];  // a + in an address means a space
}

function cameraFrom(list) {
  const [kind, ...numbers] = (list ?? '').split(',');
  const values = numbers.map(Number);
  if (!['h', 'p'].includes(kind) || values.length !== 10 || !values.every(Number.isFinite)) return null;
  const place = { position: values.slice(1, 4), target: values.slice(4, 7), up: values.slice(7, 10) };
  const isLens = values[0] > 0 && (kind === 'h' || values[0] < 180);
  if (!isLens || place.position.every((x, i) => x === place.target[i]) || place.up.every((x) => x === 0)) return null;
  if (kind === 'h') return { type: 'orthographic', height: values[0], ...place };
  return { type: 'perspective', fov_y_deg: values[0], ...place };
}

const pipe = (bytes, stream) => new Response(new Blob([bytes]).stream().pipeThrough(stream));
const deflate = async (text) => new Uint8Array(await pipe(text, new CompressionStream('deflate')).arrayBuffer());
const inflate = (bytes) => pipe(bytes, new DecompressionStream('deflate')).text();

function toBase64Url(bytes) {
  let binary = '';
  for (const byte of bytes) binary += String.fromCharCode(byte);
  return btoa(binary).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '');
}

function fromBase64Url(text) {
  try {
    return Uint8Array.from(atob(text.replaceAll('-', '+').replaceAll('_', '/')), (c) => c.charCodeAt(0));
  } catch {
    return new Uint8Array();
  }
}
