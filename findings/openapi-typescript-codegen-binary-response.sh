#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# openapi-typescript-codegen makes TypeScript clients from OpenAPI descriptions; pinned here: npm version 0.29.0, with
# its usual client, fetch.
#
# Expected: an answer of type image/png with the schema {type: string, format: binary} is any sequence of octets
# (OpenAPI 3.0.3, Data Types). The generated method is declared to give a Blob, so the caller ought to get the octets.
#
# Found: the declaration says Blob, but the generated code reads every answer that is not JSON as text. The method gives
# a string in which each octet that is not UTF-8 has become the same replacement character. The compiler accepts calls
# of Blob methods on it, which are then missing, and the picture can't be got back from the string.
#
# Why it matters to a user of a render server: pictures are what it serves. A client made from its description compiles
# without a complaint, and yet can't fetch one.
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
stop() { echo "CHANGED OR UNTESTED: $*" >&2; exit 1; }

cd "$work"
npm init --yes >npm.log 2>&1
npm install --save-exact --no-audit --no-fund --no-update-notifier openapi-typescript-codegen@0.29.0 typescript@5.4.5 \
  >>npm.log 2>&1 || stop "npm could not install the pinned versions: $(tail -n 3 npm.log)"

cat >api.json <<'JSON'
{
  "openapi": "3.0.3",
  "info": { "title": "Pictures", "version": "1.0.0" },
  "paths": {
    "/image": {
      "get": {
        "operationId": "getImage",
        "responses": {
          "200": {
            "description": "The picture.",
            "content": { "image/png": { "schema": { "type": "string", "format": "binary" } } }
          }
        }
      }
    }
  }
}
JSON
node_modules/.bin/openapi --input api.json --output client --client fetch

# That this compiles under strict rules shows that the declared type is Blob.
cat >use.ts <<'TS'
import { DefaultService, OpenAPI } from './client';
export const getPicture = (base: string): Promise<Blob> => {
  OpenAPI.BASE = base;
  return DefaultService.getImage();
};
export const sizeOf = async (picture: Blob): Promise<number> => (await picture.arrayBuffer()).byteLength;
TS
cat >tsconfig.json <<'JSON'
{
  "compilerOptions": {
    "strict": true, "target": "es2022", "lib": ["es2022", "dom", "dom.iterable"], "types": [], "skipLibCheck": true,
    "module": "commonjs", "outDir": "js"
  },
  "files": ["use.ts"]
}
JSON
node_modules/.bin/tsc || stop "the generated client does not compile, or no longer declares a Blob"

cat >check.js <<'JS'
const versionOf = (name) => require(`./node_modules/${name}/package.json`).version;
const { getPicture, sizeOf } = require('./js/use.js');
const sent = Buffer.from([0x89, 0x9a, 0xab, 0xbc, 0xcd, 0xde, 0xef, 0xf8]);
const server = require('http').createServer((request, response) => {
  response.writeHead(200, { 'Content-Type': 'image/png', 'Content-Length': sent.length });
  response.end(sent);
});
server.listen(0, '127.0.0.1', async () => {
  const base = `http://127.0.0.1:${server.address().port}`;
  const plain = Buffer.from(await (await fetch(`${base}/image`)).arrayBuffer());
  const picture = await getPicture(base);
  const size = await sizeOf(picture).catch((error) => error.constructor.name);
  const isText = typeof picture === 'string';
  const back = isText ? Buffer.from(picture, 'utf8') : sent;
  const kinds = new Set(picture);
  const packages = ['openapi-typescript-codegen', 'typescript'];
  console.log(`Version: ${packages.map((name) => `${name} ${versionOf(name)}`).join(', ')}`);
  console.log(`Input: ${sent.toString('hex')}, sent as image/png; fetch alone receives ${plain.toString('hex')}.`);
  console.log(`Seen: declared a Blob; at run time a ${isText ? 'string' : picture.constructor.name}.`);
  console.log(`Seen: calling arrayBuffer() on it gives ${size}.`);
  console.log(`Seen: ${isText ? picture.length : '-'} characters, of ${kinds.size} kind(s): ${back.toString('hex')}.`);
  const asStated = plain.equals(sent) && isText && size === 'TypeError' && kinds.size === 1 && kinds.has('\ufffd');
  server.close();
  server.closeAllConnections();
  process.exitCode = asStated ? 0 : 1;
});
JS
node check.js || stop "the generated client did not give the string stated at the top of this script"
echo "As stated: the method declared to give a Blob gives a string from which the octets are lost."
