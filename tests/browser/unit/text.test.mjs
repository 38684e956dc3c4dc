// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { parseRenderInfo, parseServerTiming } from '../../../web/js/api.js';
import { findPosition, inOneLine, offsetOf, sameCamera, tokenEnd, withFen } from '../../../web/js/scene_text.js';
import { curlCommand, decodeLink, encodeLink, linkWith, stillDocument } from '../../../web/js/share.js';

const kStart = 'rnbqkbnr/pppppppp/8/8/8/8/PPPPPPPP/RNBQKBNR';
const kText = `{
  "objects": [
    {"type": "sphere"},
    {"type": "chess_position",   "fen" : "${kStart}"}
  ],
  "camera": {"position": [1, 2, 3]}
}
`;
const kCamera = { type: 'perspective', fov_y_deg: 31.5, position: [1.25, -2, 3e-7], target: [0, 0.5, 0], up: [0, 1, 0] };

test('a new FEN changes nothing else in the text', () => {
  assert.equal(withFen(kText, '8/8/8/8/8/8/8/K6k'), kText.replace(kStart, '8/8/8/8/8/8/8/K6k'));
});

test('a FEN with signs that patterns and strings care about arrives as typed', () => {
  const odd = '$& "quote" \\ $1';
  assert.equal(findPosition(JSON.parse(withFen(kText, odd))).fen, odd);
});

test('a position without a FEN gets one', () => {
  const text = '{"objects": [{"type": "chess_position"}]}';
  assert.equal(findPosition(JSON.parse(withFen(text, '8/8/8/8/8/8/8/8'))).fen, '8/8/8/8/8/8/8/8');
});

test('a FEN goes into a text that is still being written, and nothing else changes', () => {
  const draft = kText.replace('{"type": "sphere"}', '{"type": "sphere", "rad');
  assert.equal(withFen(draft, '8/8/8/8/8/8/8/K6k'), draft.replace(kStart, '8/8/8/8/8/8/8/K6k'));
});

test('a FEN goes into a position that has none without another character being touched', () => {
  const text = '{"x-big": 12345678901234567890, "objects": [ {"type" : "chess_position" , "detail": 8e0} ]}\r\n';
  assert.equal(withFen(text, '8/8'), text.replace('"chess_position"', '"chess_position", "fen": "8/8"'));
});

test('a FEN that was written with escapes, or is none, is replaced where it stands', () => {
  const escaped = kText.replace('rnbqkbnr/pppp', '\\u0072nbqkbnr\\/pppp');
  assert.equal(withFen(escaped, '8/8'), kText.replace(kStart, '8/8'));
  assert.equal(withFen(kText.replace(`"${kStart}"`, 'null'), '8/8'), kText.replace(kStart, '8/8'));
});

test('a FEN with line ends, tabs and other spaces goes into the text as it is', () => {
  const pasted = '  8/8/8/4k3/8/4K3/4P3/8\r\nw\t-\u00a0- 0 1\n';
  const text = withFen(kText, pasted);
  assert.equal(findPosition(JSON.parse(text)).fen, pasted);
  assert.equal(text.split('\n').length, kText.split('\n').length);
});

test('a FEN on several lines keeps its fields apart and its ranks together', () => {
  assert.equal(inOneLine('8/8/8/4k3/8/4K3/4P3/8\r\nw - -\n0 1\n'), '8/8/8/4k3/8/4K3/4P3/8 w - - 0 1 ');
  assert.equal(inOneLine('8/8/8/4k3/\n8/4K3/\n4P3/8'), '8/8/8/4k3/8/4K3/4P3/8');
  const plain = ' 8/8/8/4k3/8/4K3/4P3/8\tw\u00a0- - 0 1 ';
  assert.equal(inOneLine(plain), plain);
});

test('of two keys that are called fen the position\'s own is replaced', () => {
  const text = kText.replace('"camera"', '"x-fen": {"fen": "8/8"}, "camera"').replace('{\n', '{\n  "extras": {"fen": "old"},\n');
  assert.equal(withFen(text, '9'), text.replace(kStart, '9'));
});

test('of two keys that are called fen and have one value the position\'s own is replaced', () => {
  const text = kText.replace('{\n', `{\n  "extras": {"fen": "${kStart}"},\n`);
  const changed = JSON.parse(withFen(text, '9'));
  assert.equal(findPosition(changed).fen, '9');
  assert.equal(changed.extras.fen, kStart);
});

test('a text without a position has no place for a FEN', () => {
  for (const text of ['{"objects": [{"type": "sphere"}]}', '{"objects": [', '{"objects": 3}', 'null', '']) {
    assert.equal(withFen(text, '8/8/8/8/8/8/8/8'), null);
  }
});

test('an edit keeps the camera unless it is the camera that was edited', () => {
  assert.ok(sameCamera(kText, kText.replace('sphere', 'cube')));
  assert.ok(!sameCamera(kText, kText.replace('[1, 2, 3]', '[1, 2, 4]')));
});

test('a line and column lead to their place, and a token is marked whole', () => {
  const start = offsetOf(kText, 3, 6);
  assert.equal(kText.slice(start, tokenEnd(kText, start)), '"type"');
  assert.equal(offsetOf(kText, 99, 1), kText.length);
  assert.equal(offsetOf('ab\ncd', 1, 40), 2);
  assert.equal(tokenEnd('-1.5e3, 2', 0), 6);
});

test('a link brings back scene, text and camera', async () => {
  const named = await decodeLink(await encodeLink({ scene: 'opening', camera: kCamera }));
  assert.equal(named.scene, 'opening');
  assert.deepEqual(named.camera, kCamera);
  const written = await decodeLink(await encodeLink({ text: kText, camera: kCamera }));
  assert.equal(written.text, kText);
  const flat = { type: 'orthographic', height: 7, position: [0, 9, 1], target: [0, 0, 0], up: [0, 0, -1] };
  assert.deepEqual((await decodeLink(await encodeLink({ scene: 'x', camera: flat }))).camera, flat);
});

test('a link holds every digit, and no sign that an address would change', async () => {
  const cameras = [
    { type: 'perspective', fov_y_deg: 40 / 3, position: [10000000.123456789, -7e6, 0.1 + 0.2], target: [1e7, -7e6, 1e-12 / 3], up: [0, 1, 0] },
    { type: 'orthographic', height: 1e22 / 3, position: [2e29 / 3, -1e21, 5e-324], target: [0, 0, 1e15], up: [1e-30, -1, 0] },
  ];
  for (const camera of cameras) {
    const link = await encodeLink({ scene: 'opening', camera });
    assert.match(link, /^#scene=opening&camera=[hp](,-?[\d.]+(e-?\d+)?){10}$/);
    assert.deepEqual((await decodeLink(link)).camera, camera);
    assert.deepEqual((await decodeLink(new URL(link, 'http://localhost/').hash)).camera, camera);
  }
});

test('a link from before, of five digits, is still read', async () => {
  const { camera } = await decodeLink('#scene=cubes&camera=p,33,9.1234,4,2,0,1,0,0,1,0');
  assert.deepEqual(camera, { type: 'perspective', fov_y_deg: 33, position: [9.1234, 4, 2], target: [0, 1, 0], up: [0, 1, 0] });
});

test('a camera that sees nothing is none', async () => {
  for (const list of ['p,0,9,4,2,0,1,0,0,1,0', 'p,180,9,4,2,0,1,0,0,1,0', 'h,-1,9,4,2,0,1,0,0,1,0', 'p,33,9,4,2,9,4,2,0,1,0', 'p,33,9,4,2,0,1,0,0,0,0']) {
    assert.equal((await decodeLink(`#camera=${list}`)).camera, null, list);
  }
});

test('a broken link is no link, and one with a text that cannot be read is known as damaged', async () => {
  const nothing = { scene: null, text: null, camera: null, rule: null, method: {}, isDamaged: false };
  for (const hash of ['', '#', '#camera=p,1,2', '#camera=p,a,b,c,d,e,f,g,h,i,j']) {
    assert.deepEqual(await decodeLink(hash), nothing);
  }
  const whole = await encodeLink({ text: kText });
  for (const hash of ['#json=%%%', '#json=AAAA', '#json=', whole.slice(0, whole.length / 2)]) {
    assert.deepEqual(await decodeLink(hash), { ...nothing, isDamaged: true });
  }
});

test('what is sent for a still picture keeps the exposure and takes camera and size from the window', () => {
  const text = '{"image": {"width": 9, "height": 9, "exposure": 1}, "objects": []}';
  const document = stillDocument(text, { camera: kCamera, image: { width: 640, height: 360 } });
  assert.deepEqual(document, { image: { width: 640, height: 360, exposure: 1 }, objects: [], camera: kCamera });
});

test('a stop rule goes into a link and into a still picture, in place of what the scene says', async () => {
  const rule = { key: 'rmse', value: 0.004 };
  const link = await encodeLink({ scene: 'opening', camera: kCamera, rule });
  assert.match(link, /&rmse=0\.004$/);
  assert.deepEqual((await decodeLink(link)).rule, rule);
  assert.equal(linkWith(link, {}), await encodeLink({ scene: 'opening', camera: kCamera }));
  assert.equal(linkWith('', { rule: { key: 'time_ms', value: 500 } }), '#time_ms=500');
  for (const odd of ['#rmse=', '#rmse=-1', '#rmse=x', '#samples=1.5', '#samples=0', '#time_ms=1e9']) {
    assert.equal((await decodeLink(odd)).rule, null, odd);
  }
  const text = '{"render": {"samples": 16, "passes": [1, 15], "max_depth": 10}, "objects": []}';
  const { render } = stillDocument(text, { camera: kCamera, image: {}, rule });
  assert.deepEqual(render, { max_depth: 10, rmse: 0.004 });
});

test('a method goes into a link and into a still picture, over what the scene says', async () => {
  const method = { algorithm: 'zbuffer', shading: 'gouraud' };
  const link = await encodeLink({ scene: 'opening', camera: kCamera, method });
  assert.match(link, /&algorithm=zbuffer&shading=gouraud$/);
  assert.deepEqual((await decodeLink(link)).method, method);
  assert.deepEqual((await decodeLink('#shading=flat')).method, { shading: 'flat' });
  assert.equal(linkWith(link, {}), await encodeLink({ scene: 'opening', camera: kCamera }));
  const text = '{"render": {"algorithm": "warnock", "seed": 3}, "objects": []}';
  assert.deepEqual(stillDocument(text, { camera: kCamera, image: {}, method: { shading: 'flat' } }).render,
    { algorithm: 'warnock', seed: 3, shading: 'flat' });
  assert.equal('render' in stillDocument('{"objects": []}', { camera: kCamera, image: {}, method: {} }), false);
});

test('a curl command holds the scene where the shell changes nothing', () => {
  const command = curlCommand('http://127.0.0.1:1', { name: "it's $HOME `x`" });
  assert.doesNotMatch(command, /Prefer/, 'the server waits as long as it does by itself');
  assert.match(command, /<<'SCENE'\n\{"name":"it's \$HOME `x`"\}\nSCENE\n$/);
});

test('Render-Info is read, also where samples are no whole number or the error is unknown', () => {
  assert.deepEqual(parseRenderInfo('spp=12.625, stop="rmse", rmse=0.003712, nonfinite=0'), { spp: 12.625, rmse: 0.003712, stop: 'rmse' });
  assert.deepEqual(parseRenderInfo('spp=1, nonfinite=0'), { spp: 1, rmse: null, stop: null });
  assert.deepEqual(parseRenderInfo(null), { spp: 0, rmse: null, stop: null });
});

test('Server-Timing is read by name', () => {
  assert.deepEqual(parseServerTiming('parse;dur=0.4, render;desc="a";dur=12.5'), { parse: 0.4, render: 12.5 });
  assert.deepEqual(parseServerTiming(null), {});
});
