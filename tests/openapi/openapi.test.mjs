// SPDX-License-Identifier: Apache-2.0
// The description of the API by itself, in a file, without the server that it came from: a linter finds nothing in it,
// two generators make clients of it, the compiler takes them, and they render.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { copyFile, mkdir, rm, writeFile } from 'node:fs/promises';
import { after, before, test } from 'node:test';
import { promisify } from 'node:util';
import { createConfig, lintFromString } from '@redocly/openapi-core';
import { startServer } from '../support/server.mjs';

const kHere = new URL('./', import.meta.url).pathname;
const kGenerated = `${kHere}generated/`;
const kFile = `${kGenerated}openapi.json`;
const run = promisify(execFile);
const tool = (path, ...args) => run(process.execPath, [`${kHere}node_modules/${path}`, ...args], { cwd: kHere });

let server;
let text;
before(async () => {
  server = await startServer();
  text = await (await fetch(`${server.url}/openapi.json`)).text();
  await rm(kGenerated, { recursive: true, force: true });
  await mkdir(kGenerated);
  await writeFile(kFile, text);
  await writeFile(`${kGenerated}package.json`, '{"type": "commonjs"}');  // generators leave endings out of imports
});
after(() => server?.stop());

function* referencesIn(json) {
  if (typeof json?.$ref === 'string') yield json.$ref;
  if (json && typeof json === 'object') for (const child of Object.values(json)) yield* referencesIn(child);
}

test('the document needs no other: every reference leads into itself', () => {
  const document = JSON.parse(text);
  const references = new Set(referencesIn(document));
  assert.ok(references.has('#/components/schemas/Scene'));
  for (const reference of references) {
    const parts = reference.split('/');
    assert.equal(parts.shift(), '#', reference);
    const target = parts.reduce((at, key) => at?.[key.replaceAll('~1', '/').replaceAll('~0', '~')], document);
    assert.notEqual(target, undefined, reference);
  }
});

test('the scene in it is the scene language of /v1/schema/scene.json, definition by definition', async () => {
  const schema = await (await fetch(`${server.url}/v1/schema/scene.json`)).json();
  const { schemas } = JSON.parse(text).components;
  assert.deepEqual(schemas.Scene.required, schema.required);
  assert.deepEqual(Object.keys(schemas.Scene.properties), Object.keys(schema.properties));
  for (const [name, definition] of Object.entries(schema.$defs)) {
    const renamed = `Scene${name.split('_').map((word) => word[0].toUpperCase() + word.slice(1)).join('')}`;
    assert.deepEqual(Object.keys(schemas[renamed] ?? {}), Object.keys(definition), name);
  }
});

test('every operation has an id of its own', () => {
  const operations = Object.values(JSON.parse(text).paths)
    .flatMap((item) => Object.entries(item)).filter(([method]) => method !== 'parameters').map(([, it]) => it);
  const ids = operations.map((operation) => operation.operationId);
  assert.equal(new Set(ids).size, operations.length);
  for (const id of ids) assert.match(id, /^[a-z][A-Za-z]+$/);
});

test('redocly finds neither an error nor a warning in it', async () => {
  const config = await createConfig({
    extends: ['recommended-strict'],
    rules: { 'no-required-schema-properties-undefined': 'error', 'operation-operationId': 'error' },
  });
  const found = await lintFromString({ source: text, absoluteRef: kFile, config });
  assert.deepEqual(found.map((it) => `${it.ruleId} at ${it.location[0].pointer}: ${it.message}`), []);
});

// Compiles clients/NAME.ts with all that it imports, as strictly as the compiler knows, and runs it against the server.
async function compileAndRun(name) {
  const out = `${kGenerated}compiled-${name}/`;
  await copyFile(`${kHere}clients/${name}.ts`, `${kGenerated}${name}.ts`);
  const { stdout } = await tool('typescript/bin/tsc', '--strict', '--noUncheckedIndexedAccess', '--skipLibCheck',
    '--target', 'es2022', '--module', 'node16', '--lib', 'es2022,dom,dom.iterable', '--rootDir', kGenerated,
    '--outDir', out, `${kGenerated}${name}.ts`).catch((error) => error);
  assert.equal(stdout, '', 'the compiler has nothing to say');
  const { renderABall } = await import(`${out}${name}.js`);
  const { scene, state, png } = await renderABall(server.url);
  assert.match(scene, /^[0-9a-f]{64}$/);
  assert.equal(state, 'done');
  assert.equal(Buffer.from(png).subarray(0, 8).toString('hex'), '89504e470d0a1a0a', 'a PNG begins so');
}

test('openapi-typescript makes types by which openapi-fetch renders a scene', { timeout: 120_000 }, async () => {
  await tool('openapi-typescript/bin/cli.js', kFile, '-o', `${kGenerated}types.ts`);
  await compileAndRun('by_types');
});

test('openapi-ts of Hey API makes functions that render a scene', { timeout: 120_000 }, async () => {
  await tool('@hey-api/openapi-ts/bin/index.cjs', '-i', kFile, '-o', `${kGenerated}functions`,
    '-c', '@hey-api/client-fetch');
  await compileAndRun('by_functions');
});
