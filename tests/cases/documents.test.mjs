// SPDX-License-Identifier: Apache-2.0
// Documents as people write and paste them: chess positions, meshes in lists, bytes that are no JSON, boards from above.
import assert from 'node:assert/strict';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { explainPixel, inputPath, jobDone, post, put, readInput, readJson, startServer, tilelight, tilelightd } from './harness.mjs';

const kStart = 'rnbqkbnr/pppppppp/8/8/8/8/PPPPPPPP/RNBQKBNR';
// eslint-disable-next-line no-control-regex
const kControls = /[\u0000-\u0009\u000b-\u001f\u007f-\u009f\u200b-\u200f\u2028-\u202e\u2060-\u2069\ufeff]/;

let server;
let folder;
before(async () => {
  folder = await mkdtemp(join(tmpdir(), 'tilelight-documents-'));
  server = await startServer();
});
after(async () => {
  await server?.stop();
  await rm(folder, { recursive: true });
});

const problemOf = async (answer) => ({ status: answer.status, ...(await answer.json()) });

// --- Chess positions

const boardOf = (fen) => ({
  image: { width: 96, height: 96 }, render: { samples: 1 },
  camera: { type: 'orthographic', position: [0, 8, 0], height: 9 },
  objects: [{ type: 'chess_position', fen, detail: 8 }],
});

// The picture, or the problem.
async function draw(scene) {
  const answer = await post(server, '/v1/renders', scene, { Accept: 'image/png' });
  if (answer.status !== 200) return { problem: await problemOf(answer) };
  return { picture: Buffer.from(await answer.arrayBuffer()).toString('base64') };
}

const pictures = new Map();
async function pictureOf(squares) {
  if (!pictures.has(squares)) pictures.set(squares, (await draw(boardOf(squares))).picture);
  return pictures.get(squares);
}

async function assertDrawn(fen, squares, what) {
  const { picture, problem } = await draw(boardOf(fen));
  assert.ok(picture, `${what}: ${JSON.stringify(fen)} is refused: ${JSON.stringify(problem?.errors)}`);
  assert.equal(picture, await pictureOf(squares), `${what}: another picture than ${squares}`);
}

// The lines of fens.tsv as {line, program, squares, refusal}.
async function readLines() {
  const text = (await readInput('fens.tsv')).toString();
  return text.split('\n').filter((line) => line && !line.startsWith('#')).map((row) => {
    const [line, program, expected] = row.split('\t');
    const refusal = /^REFUSE: (.*)/.exec(expected)?.[1];
    return { line: line.replaceAll('\\n', '\n').replaceAll('\\t', '\t'), program, refusal, squares: expected };
  });
}

// What a refusal has to say, by what the table says.
const kReasons = new Map([
  ['ten files', /8 ranks of 10 files/],
  ['ten ranks of nine files', /10 ranks of 9 files/],
  ['nine ranks of nine files', /9 ranks of 9 files/],
  ['a diagram, no FEN', /a diagram, no FEN/],
]);

test('what programs write is drawn or refused for a reason that is told', async () => {
  const lines = await readLines();
  assert.ok(lines.length >= 39);
  for (const { line, program, refusal, squares } of lines) {
    if (!refusal) {
      await assertDrawn(line, squares, program);
      continue;
    }
    const { problem } = await draw(boardOf(line));
    assert.equal(problem?.status, 422, program);
    assert.equal(problem.errors[0].pointer, '/objects/0/fen');
    assert.match(problem.errors[0].detail, kReasons.get(refusal), program);
    assert.doesNotMatch(JSON.stringify(problem.errors), /\\[nrtu]/, 'no control characters in messages');
  }
});

test('two positions give two pictures, so that equal ones tell something', async () => {
  assert.notEqual(await pictureOf(kStart), await pictureOf('rnbqkbnr/pppppppp/8/8/8/8/PPPPPPPP/RNBKQBNR'));
});

test('what people paste is drawn', async () => {
  for (const { what, fen, squares } of await readJson('positions_as_pasted.json')) await assertDrawn(fen, squares, what);
});

test('what is left out of a position is told by the plan and by the job, and nothing else is', async () => {
  const told = async (fen) => {
    const plan = await (await post(server, '/v1/plan', boardOf(fen))).json();
    const job = await (await post(server, '/v1/renders', boardOf(fen))).json();
    const warnings = (document) => document.warnings.filter(({ code }) => code === 'fen_left_out');
    assert.deepEqual(warnings(job), warnings(plan));
    for (const { pointer } of warnings(plan)) assert.equal(pointer, '/objects/0/fen');
    return warnings(plan).map(({ detail }) => detail).join('\n');
  };
  assert.equal(await told(kStart), '');
  assert.equal(await told(`${kStart}\tw KQkq\n- 0 1 `), '');
  assert.match(await told(`${kStart}[Qp] w KQkq - 0 1`), /the pocket "\[Qp\]" is left out/);
  assert.match(await told(`Q~${kStart.slice(1)}`), /'~'/);
  assert.match(await told(`${kStart} w KQkq - bm e4; id "a";`), /"bm e4; id "a" is left out/);
  assert.match(await told(`horde:${kStart} w KQkq - 0 1`), /"horde:" is left out/);
  assert.equal(await told(`{"fen": "${kStart} w KQkq - 0 1"}`), '');
  assert.match(await told(`3, a/b: ${kStart} w KQkq - 0 1`), /^"3, a\/b:" is left out$/);
  assert.match(await told('rnsmksnr/8/pppppppp/8/8/PPPPPPPP/8/RNSKMSNR'), /makruk are drawn as bishops and queens/);
  assert.match(await told(`${kStart} w - -\n${kStart} b - -`), /of several positions the first is drawn/);
});

test('the command draws and refuses as the server does, and says on the terminal what it left out', async () => {
  const image = join(folder, 'board.png');
  const chess = (fen) => tilelight('chess', fen, '-o', image, '--width', '32', '--height', '32', '--samples', '1', '--detail', '8');
  const hashOf = async (fen) => {
    const { code, stderr } = await chess(fen);
    assert.equal(code, 0, stderr);
    return { bytes: (await readFile(image)).toString('base64'), stderr };
  };
  const plain = await hashOf(kStart);
  assert.doesNotMatch(plain.stderr, /warning/);
  for (const fen of [`${kStart}[Pp]\tw KQkq - 0 1`, `position fen ${kStart} w KQkq - 0 1 moves e2e4`,
    `[FEN "${kStart} w KQkq - 0 1"]\n\n1. e4 *`]) {
    const { bytes, stderr } = await hashOf(fen);
    assert.equal(bytes, plain.bytes);
    assert.match(stderr, /warning: .* left out/);
  }
  assert.match((await tilelight('chess', `${kStart}[]`, '--scene')).stderr, /warning: the pocket/);
  for (const { line, refusal } of await readLines()) {
    if (!refusal) continue;
    const { code, stderr } = await chess(line);
    assert.equal(code, 2);
    assert.match(stderr, kReasons.get(refusal));
    assert.doesNotMatch(stderr, kControls);
  }
});

test('messages name characters and hold none that a terminal would act on', async () => {
  const kOdd = [['\u001b[2J', 'U\\+001B'], ['\u0000', 'U\\+0000'], ['\u009b', 'U\\+009B'], ['\u00e9', "'\u00e9' \\(U\\+00E9\\)"],
    ['\uff18', "'\uff18' \\(U\\+FF18\\)"], ['x', "'x'"]];
  for (const [odd, name] of kOdd) {
    const { problem } = await draw(boardOf(`8/8/8/8/8/8/8/7${odd}`));
    assert.equal(problem.status, 422);
    assert.match(problem.errors[0].detail, new RegExp(`found ${name} in rank 1`));
    assert.doesNotMatch(problem.errors[0].detail, kControls);
  }
  const path = join(folder, 'keys.json');
  await writeFile(path, JSON.stringify({ objects: [{ type: 'cube', 'a\u001b]0;x\u0007\u202e': 1 }], 'b\u009b': 2 }));
  const { code, stderr } = await tilelight('plan', path);
  assert.equal(code, 2);
  assert.doesNotMatch(stderr, kControls);
  assert.match(stderr, /\\u001b\]0;x\\u0007\\u202e/);
});

test('the length of a position has one limit, which is published and which schema and parser share', async () => {
  const limit = (await (await fetch(`${server.url}/v1/limits`)).json()).fen_characters;
  const fen = (await fenSchema()).maxLength;
  assert.equal(fen, limit);
  const padded = (length) => `${kStart} w KQkq - c0 "`.padEnd(length, '\u00e9');
  await assertDrawn(padded(limit), kStart, 'as long as may be');
  const { problem } = await draw(boardOf(padded(limit + 1)));
  assert.match(problem.errors[0].detail, /found 4097 characters; allowed: at most 4096 \(limit fen_characters\)/);
});

// --- The schema

async function fenSchema() {
  const schema = JSON.parse((await tilelight('schema')).stdout.toString());
  assert.deepEqual(schema, await (await fetch(`${server.url}/v1/schema/scene.json`)).json());
  return schema.$defs.chess_position.properties.fen;
}

// As validators read patterns: ECMA-262 with the flag u, anywhere in the text.
test('the pattern of the schema matches all that is drawn and refuses what a pattern can', async () => {
  const pattern = new RegExp((await fenSchema()).pattern, 'u');
  for (const { line, program, refusal } of await readLines()) assert.equal(pattern.test(line), !refusal, program);
  for (const { what, fen } of await readJson('positions_as_pasted.json')) assert.ok(pattern.test(fen), what);
  for (const fen of ['', '8/8', '8/8/8/8/8/8/8', '8/8/8/8/8/8/8/8/8', '8/8/8/9/8/8/8/8', '8/8/8/8/8/8/8/7x', 'startpos',
    '8/8/8/8//8/8/8', 'x8/8/8/8/8/8/8/8', '~8/8/8/8/8/8/8/8', '1. 8/8/8/8*/8/8/8/8',
    '8 8 8 8 8 8 8 8', `${kStart}/RNBQKBNR`, 'ppppppppp/8/8/8/8/8/8/8', `https://a.org/${kStart}`, '[Event "?"]\n\n1. e4 *']) {
    assert.ok(!pattern.test(fen), fen);
    assert.equal((await draw(boardOf(fen))).problem?.status, 422, fen);
  }
});

test('the pattern takes no time over texts that almost match', async () => {
  const pattern = new RegExp((await fenSchema()).pattern, 'u');
  const kParts = ['a:', 'fen ', '"', ' ', '8/', '[FEN "', '[', 'p~', '8 ', 'a', '/', '_"', '.', ' .', '/ ', ' /', '%20', '%2F',
    '%3D', '%20%2F', '\u200b', '8\u200b', '8/8/8/8/8/8/8/', '(8.', 'p.p/', '://'];
  const texts = kParts.map((part) => part.repeat(Math.floor(4096 / part.length)));
  for (const text of [...texts, `8${'\u200b'.repeat(4095)}`, `8${' '.repeat(4095)}`, `x${'.'.repeat(4095)}`]) {
    const begin = performance.now();
    assert.equal(pattern.test(text), false, text.slice(0, 20));
    assert.ok(performance.now() - begin < 100, text.slice(0, 20));
  }
});

// --- Meshes in lists

const kPositions = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
const kIndices = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
const meshScene = (positions, indices, members = {}) => ({
  image: { width: 48, height: 32 }, render: { samples: 1 },
  meshes: { tetra: { positions, indices, ...members } }, objects: [{ type: 'mesh', mesh: 'tetra' }],
});

test('a mesh in lists of three is the mesh of the flat list: one id, one picture', async () => {
  const normals = kPositions.map(() => [0, 0, 1]);
  const flat = meshScene(kPositions.flat(), kIndices.flat(), { normals: normals.flat() });
  for (const scene of [meshScene(kPositions, kIndices, { normals }), meshScene(kPositions, kIndices.flat(), { normals: normals.flat() })]) {
    const ids = await Promise.all([flat, scene].map(async (s) => (await (await post(server, '/v1/scenes', s)).json()).id));
    assert.equal(ids[0], ids[1]);
    assert.equal((await draw(scene)).picture, (await draw(flat)).picture);
  }
});

test('a list that is not of three is told by its place', async () => {
  const errorOf = async (scene) => (await draw(scene)).problem.errors[0];
  const replaced = (list, i, entry) => list.map((row, j) => (i === j ? entry : row));
  const cases = [
    [meshScene(replaced(kPositions, 2, [0, 1]), kIndices), '/meshes/tetra/positions/2', /found a list of 2 numbers; allowed: 3 numbers/],
    [meshScene(kPositions, replaced(kIndices, 1, [0, 1, 3, 2])), '/meshes/tetra/indices/1', /found a list of 4 numbers; allowed: 3/],
    [meshScene(replaced(kPositions, 3, 7), kIndices), '/meshes/tetra/positions/3', /found 7; allowed: 3 numbers/],
    [meshScene([...kPositions.flat(), [1, 1, 1]], kIndices), '/meshes/tetra/positions/12', /found a list of 3 numbers; allowed: a number/],
    [meshScene(kPositions, replaced(kIndices, 3, [1, 2, 4])), '/meshes/tetra/indices/3/2', /found index 4; allowed: 0 to 3/],
    [meshScene(replaced(kPositions, 0, [0, '0', 0]), kIndices), '/meshes/tetra/positions/0/1', /"0" \(a string\)/],
  ];
  for (const [scene, pointer, detail] of cases) {
    const error = await errorOf(scene);
    assert.equal(error.pointer, pointer);
    assert.match(error.detail, detail);
    assert.ok(error.line > 0);
  }
});

// --- What is no JSON

const kRefinable = { image: { width: 16, height: 16 }, render: { samples: 1 }, objects: [{ type: 'sphere' }] };

const putView = (session, body) => put(server, `/v1/sessions/${session.id}/view`, body);

// Every path that takes JSON, with a body that it accepts: {send(body), body}.
async function takersOfJson() {
  const job = (await post(server, '/v1/renders', kRefinable, { Prefer: 'wait=30' }));
  const location = job.headers.get('location') ?? `/v1/renders/${(await job.clone().json()).id}`;
  await jobDone(server, location);
  const session = await (await post(server, '/v1/sessions', kRefinable)).json();
  const scene = JSON.stringify(kRefinable);
  const wrapped = `{"scene": ${scene}, "image": {"width": 8, "height": 8}}`;
  let seq = 0;
  return [
    ...['/v1/plan', '/v1/scenes', '/v1/renders', '/v1/sessions'].map((path) => ({ name: path, send: (body) => post(server, path, body), body: scene })),
    ...['/v1/plan', '/v1/renders', '/v1/sessions'].map((path) => ({ name: `${path}, wrapped`, send: (body) => post(server, path, body), body: wrapped })),
    { name: 'refine', send: (body) => post(server, `${location}/refine`, body), body: '{"samples": 2}' },
    { name: 'view', send: (body) => putView(session, body), get body() { seq += 1; return `{"seq": ${seq}, "moving": true, "camera": {"fov_y_deg": 30}}`; } },
  ];
}

test('bytes behind a document are refused everywhere, also behind a NUL', async () => {
  const answer = await post(server, '/v1/plan', await readInput('bytes_after_nul.json'));
  const problem = await problemOf(answer);
  assert.equal(problem.status, 400);
  assert.match(JSON.stringify(problem), /U\+0000/);
  for (const { name, send, body } of await takersOfJson()) {
    for (const tail of ['\0', '\0 not JSON {{{', ' \0', '\n\0\n', '{}', ' x', ']', '\u00a0', '\u001a']) {
      assert.equal((await send(body + tail)).status, 400, `${name} with ${JSON.stringify(tail)}`);
    }
    assert.ok((await send(`${body} \t\r\n`)).ok, name);
  }
});

test('a NUL inside a document is refused, and as an escape it is text', async () => {
  const text = JSON.stringify(kRefinable);
  for (const at of [1, 10, text.length - 1]) {
    assert.equal((await post(server, '/v1/plan', `${text.slice(0, at)}\0${text.slice(at)}`)).status, 400);
  }
  assert.equal((await post(server, '/v1/plan', { ...kRefinable, 'x-note': 'a\u0000b' })).status, 200);
});

test('the command refuses bytes behind a NUL', async () => {
  const { code, stderr } = await tilelight('plan', inputPath('bytes_after_nul.json'));
  assert.equal(code, 2);
  assert.match(stderr, /bytes_after_nul\.json:1:32: found U\+0000/);
});

test('the server does not start from a configuration with bytes behind a NUL', async () => {
  const path = join(folder, 'config.json');
  await writeFile(path, '{"quiet": true}\0{"port": 1}');
  const { code, stderr } = await tilelightd(['--config', path]);
  assert.equal(code, 2);
  assert.match(stderr, /config\.json.*NUL/);
});

const kNoNumbers = ['01', '-01', '+1', '.5', '1.', '1e', '1e+', '-', '0x1', '1_000', 'NaN', 'Infinity', '-Infinity', '00', '1.e3', '\uff11', '1d', "'1'"];

test('numbers that JSON does not have are refused wherever a number stands', async () => {
  const session = await (await post(server, '/v1/sessions', kRefinable)).json();
  for (const number of kNoNumbers) {
    assert.equal((await putView(session, `{"seq": ${number}}`)).status, 400, `seq ${number}`);
    assert.equal((await putView(session, `{"seq": 1, "moving": ${number}}`)).status, 400, `moving ${number}`);
    assert.equal((await putView(session, `{"seq": 1, "camera": {"fov_y_deg": ${number}}}`)).status, 400, `camera ${number}`);
    assert.equal((await post(server, '/v1/plan', `{"ambient": ${number}, "objects": [{"type": "cube"}]}`)).status, 400, number);
    assert.equal((await post(server, '/v1/plan', `{"scene": {"objects": [{"type": "cube"}]}, "image": {"width": ${number}}}`)).status, 400, number);
    for (const member of ['priority', 'format']) {
      assert.equal((await post(server, '/v1/renders', `{"scene": {"objects": [{"type": "cube"}]}, "${member}": ${number}}`)).status, 400, `${member} ${number}`);
    }
  }
});

test('words and strings that JSON does not have are refused around a scene too', async () => {
  for (const value of ['True', 'nil', 'png', "'png'", '"p\tng"', '"\\x"', '"\\u12"', '"\\ud800"', '[1,]', '{"a" 1}', '"png" "jpeg"']) {
    const body = `{"scene": {"objects": [{"type": "cube"}]}, "format": ${value}}`;
    assert.equal((await post(server, '/v1/renders', body)).status, 400, value);
  }
  assert.equal((await post(server, '/v1/renders', '{"scene": {"objects": [{"type": "cube"}]}, "a\tb": 1}')).status, 400);
});

test('the number of a view is a whole number however JSON spells it', async () => {
  const session = await (await post(server, '/v1/sessions', kRefinable)).json();
  const statusOf = async (seq) => (await putView(session, `{"seq": ${seq}}`)).status;
  for (const seq of ['1', '2.0', '3e0', '0.4e1', '9007199254740993']) assert.equal(await statusOf(seq), 204, seq);
  for (const seq of ['0', '-0', '-1', '1.5', '1e300', '"1"', 'null', '[1]']) assert.equal(await statusOf(seq), 422, seq);
});

test('a byte order mark before a body counts for nothing, around a scene or not', async () => {
  for (const body of [JSON.stringify(kRefinable), `{"scene": ${JSON.stringify(kRefinable)}, "image": {"width": 8, "height": 8}}`]) {
    assert.equal((await post(server, '/v1/plan', `\ufeff${body}`)).status, 200);
  }
});

// --- Boards from above

const withCamera = (scene, camera) => ({ ...scene, camera: { ...scene.camera, ...camera } });

test('a board from straight above stands with -z up and +x on the right, by every method', async () => {
  const scene = await readJson('board_from_above.json');
  for (const lens of [{}, { type: 'orthographic', height: 4 }]) {
    for (const algorithm of ['raytrace', 'zbuffer', 'warnock', 'roberts']) {
      const drawn = { ...scene, render: { ...scene.render, algorithm } };
      const picture = async (camera) => (await draw(withCamera(drawn, { ...lens, ...camera }))).picture;
      const fallen = await picture({});
      assert.ok(fallen);
      assert.equal(fallen, await picture({ up: [0, 0, -1] }), algorithm);
      assert.equal(fallen, await picture({ up: [0, -3, 0] }), algorithm);
      assert.notEqual(fallen, await picture({ up: [1, 0, 0] }), algorithm);
    }
  }
});

// The blue box lies at x from 1 to 1.6 and z from 0.3 to 0.8: right of the middle and below it.
test('in a picture from above what lies south-east is on the lower right', async () => {
  const objectAt = async (x, y) => (await explainPixel('board_from_above.json', x, y)).rays[0].hit?.object;
  assert.equal(await objectAt(32, 20), 'objects/0');
  assert.equal(await objectAt(42, 24), 'objects/1');
  for (const [x, y] of [[42, 15], [21, 24], [21, 15]]) assert.equal(await objectAt(x, y), 'objects/0');
});

test('straight up, and along the other axes, one rule holds', async () => {
  const scene = await readJson('board_from_above.json');
  const picture = async (camera) => (await draw(withCamera(scene, camera))).picture;
  const kSame = [[{ position: [0, -8, 0] }, { position: [0, -8, 0], up: [0, 0, 1] }],
    [{ position: [0, 1, 8], up: [0, 1, 8] }, { position: [0, 1, 8] }],
    [{ position: [0, 0, 8], up: [0, 0, 1] }, { position: [0, 0, 8] }],
    [{ position: [8, 0, 0], up: [-1, 0, 0] }, { position: [8, 0, 0] }],
    [{ position: [5e-16, 8, -5e-16] }, { position: [5e-16, 8, -5e-16], up: [0, 0, -1] }]];
  for (const [fallen, plain] of kSame) assert.equal(await picture(fallen), await picture(plain), JSON.stringify(fallen));
});

test('an up along the view is told by the plan and the job of that view, also where the view is not the scene\'s', async () => {
  const scene = await readJson('board_from_above.json');
  const level = withCamera(scene, { position: [0, 1, 8] });
  const codesOf = (document) => document.warnings.map(({ pointer, code }) => `${pointer} ${code}`);
  const kTold = ['/camera up_parallel_to_view'];
  for (const [body, told] of [[scene, kTold], [level, []], [{ scene: level, camera: { position: [0, 8, 0] } }, kTold],
    [{ scene, camera: { position: [0, 1, 8] } }, []]]) {
    for (const path of ['/v1/plan', '/v1/sessions']) {
      assert.deepEqual(codesOf(await (await post(server, path, body)).json()), told, path);
    }
    const { id } = await (await post(server, '/v1/renders', body)).json();
    const job = await jobDone(server, `/v1/renders/${id}`);
    assert.deepEqual([codesOf(job), codesOf(job.report)], [told, told]);
  }
});

test('the command tells warnings in its plan and in its report', async () => {
  const plan = JSON.parse((await tilelight('plan', inputPath('board_from_above.json'), '--json')).stdout.toString());
  assert.equal(plan.warnings[0].code, 'up_parallel_to_view');
  assert.match(plan.warnings[0].detail, /-z takes its place/);
  const image = join(folder, 'a.png');
  const { stdout, stderr } = await tilelight('chess', `${kStart}[Qp]`, '-o', image, '--width', '16', '--height', '16',
    '--samples', '1', '--detail', '8', '--report', '-');
  assert.equal(JSON.parse(stdout.toString()).warnings[0].code, 'fen_left_out');
  assert.match(stderr, /warning: \/objects\/0\/fen: the pocket/);
});
