#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# Varnish Cache is an HTTP cache; pinned here: Debian 12 varnish 7.1.1-2+deb12u1.
#
# Expected: If-None-Match is "*" or a list of entity tags, and the condition is false, so that a GET is answered 304, if
# any member matches or if "*" meets a stored answer (RFC 9110, 13.1.2). A cache ought to evaluate it against the answer
# that it holds (RFC 9111, 4.3.2). Several lines of one list field mean the same as one line (RFC 9110, 5.3). Varnish's
# manual (vcl-var, resp.status) refers to the rules of RFC 7232, whose If-None-Match is this same list.
#
# Found: for an answer in the cache, Varnish compares the whole first If-None-Match line with the stored ETag as if it
# were one tag. A list that has the right tag, the right tag on a second line, and "*" all get 200 and the full body.
#
# Why it matters to a user of a render server: a client that keeps several versions of a picture sends all their tags to
# learn which one is current. Behind Varnish that saves nothing: each poll carries the whole picture.
set -euo pipefail

work=$(mktemp -d)
pids=()
finish() {
  local pid
  for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null || true; wait "$pid" 2>/dev/null || true; done
  rm -rf "$work"
}
trap finish EXIT
stop() { echo "CHANGED OR UNTESTED: $*" >&2; exit 1; }

# Takes the pinned packages, and those of their dependencies that this system lacks, without installing any.
fetch_debian() {
  local missing deb
  missing=$(missing_for "$@") || { apt-get update -qq && missing=$(missing_for "$@"); } ||
    stop "apt knows no way to install $*; the pinned version has to be one that Debian 12 offers"
  mkdir "$work/debs" "$work/root"
  # shellcheck disable=SC2086  # one word a package
  (cd "$work/debs" && apt-get -qq -o APT::Sandbox::User=root download "$@" $missing) ||
    stop "the packages $* could not be downloaded"
  for deb in "$work"/debs/*.deb; do dpkg -x "$deb" "$work/root"; done
}
missing_for() {
  apt-get --simulate install --no-install-recommends --allow-downgrades "$@" 2>/dev/null | awk '/^Inst/ { print $2 }'
}

fetch_debian varnish=7.1.1-2+deb12u1 libvarnishapi3=7.1.1-2+deb12u1
export LD_LIBRARY_PATH=$work/root/usr/lib/x86_64-linux-gnu
varnishd=$work/root/usr/sbin/varnishd

# Both ends are Unix sockets: no port is taken.
cat >"$work/backend.js" <<'JS'
require('http').createServer((request, response) => {
  response.writeHead(200, { ETag: '"b"', 'Cache-Control': 'max-age=600', 'Content-Length': 5 });
  response.end('image');
}).listen(process.argv[2]);
JS
cat >"$work/default.vcl" <<VCL
vcl 4.1;
backend default { .path = "$work/back.sock"; }
VCL
node "$work/backend.js" "$work/back.sock" &
pids+=($!)
for _ in {1..50}; do [[ -S $work/back.sock ]] && break; sleep 0.1; done
"$varnishd" -F -j none -n "$work/varnish" -a "$work/front.sock" -f "$work/default.vcl" -s malloc,16m \
  >"$work/varnish.log" 2>&1 &
pids+=($!)

echo "Version: $("$varnishd" -V 2>&1 | grep -m 1 -o 'varnish-[0-9.]*')"
echo 'Input: GET of a cached answer whose ETag is "b".'
cat >"$work/client.js" <<'JS'
const http = require('http');
const socketPath = process.argv[2];
const get = (lines) => new Promise((resolve, reject) => {
  const headers = lines.length ? { 'If-None-Match': lines } : {};
  http.get({ socketPath, path: '/image', headers, agent: false }, (answer) => {
    let bytes = 0;
    answer.on('data', (part) => { bytes += part.length; });
    // X-Varnish has a second number, that of the request that filled the cache, only on a hit.
    const isHit = String(answer.headers['x-varnish']).split(' ').length === 2;
    answer.on('end', () => resolve({ status: answer.statusCode, bytes, isHit }));
  }).on('error', reject);
});
const pause = () => new Promise((resolve) => setTimeout(resolve, 200));
// lines sent, status by RFC 9110, status found
const cases = [
  [['"b"'], 304, 304],
  [['W/"b"'], 304, 304],
  [['"a"'], 200, 200],
  [['"a", "b"'], 304, 200],
  [['"b", "a"'], 304, 200],
  [['W/"a", W/"b"'], 304, 200],
  [['"a"', '"b"'], 304, 200],
  [['"b"', '"a"'], 304, 304],
  [['*'], 304, 200],
];
(async () => {
  for (let tries = 0; ; ++tries) {
    const first = await get([]).catch(() => null);
    if (first && first.status === 200) break;
    if (tries === 100) throw new Error('Varnish did not answer within 20 s');
    await pause();
  }
  let same = true;
  for (const [lines, rfc, found] of cases) {
    const seen = await get(lines);
    const sent = lines.join(' then, on a second line, ').padEnd(36);
    console.log(`Seen: ${sent} ${seen.status} with ${seen.bytes} bytes of body; by RFC 9110 ${rfc}`);
    same = same && seen.status === found && seen.isHit;
  }
  process.exit(same ? 0 : 1);
})().catch((error) => { console.error(error.message); process.exit(1); });
JS
node "$work/client.js" "$work/front.sock" ||
  stop "an answer is not the one stated at the top of this script: $(tail -n 2 "$work/varnish.log")"
echo 'As stated: only the whole first If-None-Match line is compared with the ETag; lists and "*" get the full body.'
