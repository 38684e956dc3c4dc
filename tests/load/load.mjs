// SPDX-License-Identifier: Apache-2.0
// Runs wrk step by step at rising concurrency and reads the server's own counters before and after each step.
import { execFile, spawn } from 'node:child_process';
import { writeFile } from 'node:fs/promises';
import os from 'node:os';
import { fileURLToPath } from 'node:url';
import { parseArgs, promisify } from 'node:util';

const kMix = fileURLToPath(new URL('./mix.lua', import.meta.url));
const kServer = fileURLToPath(new URL('../../build/release/bin/tilelightd', import.meta.url));
const kPatienceS = 65;  // a request waits up to 60 s for its picture

const kHelp = `usage: tests/load/run [options]

POSTs four small scenes (160x90, one sample a pixel; spheres, glass and boxes, a chess piece, an endgame) at rising
concurrency, first all distinct, then identical ones, and prints a table. wrk drives a closed loop: every connection
sends its next request when it has its answer, so the times are those of a server that is never asked for more than so
many renders at once. Without --url a server of this checkout is started on free ports; wrk and the server then share
the machine.

  --url URL           a running server, e.g. http://127.0.0.1:8080
  --admin URL         its admin port, e.g. http://127.0.0.1:8081; without it no renders, rays and CPU are shown
  --connections LIST  how many at once, a step each [1,2,4,8,16,32,64]
  --seconds N         the length of a step [5]
  --json FILE         the table as JSON as well`;

// Says what is wrong with the command line and ends.
function refuse(what) {
  console.error(`tests/load/run: ${what}\n\n${kHelp}`);
  process.exit(2);
}
function readOptions(config) {
  try {
    return parseArgs(config).values;
  } catch (error) {
    return refuse(error.message);
  }
}

const options = readOptions({
  options: {
    url: { type: 'string' }, admin: { type: 'string' }, connections: { type: 'string', default: '1,2,4,8,16,32,64' },
    seconds: { type: 'string', default: '5' }, json: { type: 'string' }, help: { type: 'boolean', short: 'h' },
  },
});
if (options.help) {
  console.log(kHelp);
  process.exit(0);
}
const connections = options.connections.split(',').map(Number);
const seconds = Number(options.seconds);
if (!connections.every((n) => Number.isInteger(n) && n >= 1) || !(Number.isInteger(seconds) && seconds >= 1)) {
  refuse('--connections takes whole numbers with commas, --seconds a whole number');
}

// A server of this checkout; {url, admin, stop()}.
async function startServer() {
  const server = spawn(kServer, ['--port', '0', '--admin-port', '0', '--log-level', 'warn'], { stdio: ['ignore', 'pipe', 'inherit'] });
  const ended = new Promise((resolve) => {
    server.once('exit', resolve);
    server.once('error', () => resolve('no such program'));
  });
  const found = {};
  await new Promise((resolve, reject) => {
    let output = '';
    server.stdout.on('data', (text) => {
      output += text;
      found.url = /^Tilelight is at (\S+)\/$/m.exec(output)?.[1];
      found.admin = /(http:\/\/\S+)\/metrics/.exec(output)?.[1];
      if (found.url && found.admin) resolve();
    });
    ended.then((code) => reject(new Error(`${kServer} did not start (${code}); build it with server/run`)));
  });
  return { ...found, stop: () => { server.kill('SIGTERM'); return ended; } };
}

// The server's counters by name, added up over labels; null without an admin port.
async function readMetrics(admin) {
  if (!admin) return null;
  const text = await (await fetch(`${admin}/metrics`)).text();
  const sums = {};
  for (const line of text.split('\n')) {
    const [, name, labels = '', value] = /^(\w+)(\{.*\})? (\S+)$/.exec(line) ?? [];
    if (!name || (name === 'tilelight_renders_total' && !labels.includes('state="done"'))) continue;
    sums[name] = (sums[name] ?? 0) + Number(value);
  }
  return sums;
}

async function runWrk(url, count, kind, firstSeed) {
  const { stdout } = await promisify(execFile)('wrk', ['-t1', `-c${count}`, `-d${seconds}s`, `--timeout`, `${kPatienceS}s`,
    '-s', kMix, url, '--', kind, String(firstSeed)]);
  const [, result] = /^RESULT (.*)$/m.exec(stdout) ?? [];
  if (!result) throw new Error(`wrk said nothing of its result:\n${stdout}`);
  return JSON.parse(result);
}

async function measure({ url, admin }, kind, count, firstSeed) {
  const before = await readMetrics(admin);
  const wrk = await runWrk(url, count, kind, firstSeed);
  const after = await readMetrics(admin);
  const grown = (name) => (after ? (after[name] ?? 0) - (before[name] ?? 0) : null);
  const answered = wrk.statuses['200'] ?? 0;
  const renders = grown('tilelight_renders_total');
  return {
    kind,
    connections: count,
    requests_per_s: answered / wrk.seconds,
    renders_per_s: renders === null ? null : renders / wrk.seconds,
    mrays_per_s: renders === null ? null : grown('tilelight_rays_total') / 1e6 / wrk.seconds,
    p50_ms: wrk.p50_ms,
    p99_ms: wrk.p99_ms,
    errors: wrk.requests - answered + wrk.socket_errors + wrk.timeouts,
    cpu_ms_per_render: renders ? 1000 * grown('process_cpu_seconds_total') / renders : null,
  };
}

const kColumns = [
  ['scenes', (r) => r.kind], ['connections', (r) => r.connections], ['answers/s', (r) => r.requests_per_s.toFixed(1)],
  ['renders/s', (r) => r.renders_per_s?.toFixed(1)], ['Mrays/s', (r) => r.mrays_per_s?.toFixed(2)],
  ['p50 ms', (r) => r.p50_ms.toFixed(1)], ['p99 ms', (r) => r.p99_ms.toFixed(1)], ['errors', (r) => r.errors],
  ['CPU ms/render', (r) => r.cpu_ms_per_render?.toFixed(2)],
];
const row = (cells) => cells.map((cell, i) => String(cell ?? '-').padStart(i === 0 ? 10 : kColumns[i][0].length + 2)).join('');

const own = options.url ? null : await startServer();
const target = own ?? { url: options.url.replace(/\/$/, ''), admin: options.admin?.replace(/\/$/, '') };
const rows = [];
try {
  console.log(`${target.url}, ${seconds} s a step, closed loop (wrk), this machine: ${os.availableParallelism()} hardware threads\n`);
  console.log(row(kColumns.map(([title]) => title)));
  let firstSeed = Math.floor(Math.random() * 2 ** 32);
  for (const kind of ['distinct', 'identical']) {
    for (const count of connections) {
      rows.push(await measure(target, kind, count, firstSeed));
      firstSeed = (firstSeed + 1e6) % 2 ** 32;
      console.log(row(kColumns.map(([, cell]) => cell(rows.at(-1)))));
    }
  }
  if (options.json) await writeFile(options.json, JSON.stringify({ url: target.url, seconds, rows }, null, 2) + '\n');
} catch (error) {
  console.error(`tests/load/run: ${error.message}`);
  process.exitCode = 1;
} finally {
  await own?.stop();
}
if (rows.some(({ errors }) => errors > 0)) process.exitCode = 1;
