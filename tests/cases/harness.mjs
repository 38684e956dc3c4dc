// SPDX-License-Identifier: Apache-2.0
// What the cases need: a server, raw bytes over a socket, and the command.
import { execFile } from 'node:child_process';
import { readFile } from 'node:fs/promises';
import net from 'node:net';

export { freePort, startServer } from '../support/server.mjs';

const kInputs = new URL('./inputs/', import.meta.url).pathname;

export const inputPath = (name) => kInputs + name;
export const readInput = (name) => readFile(inputPath(name));
export const readJson = async (name) => JSON.parse(await readFile(inputPath(name), 'utf8'));

// Sends `bytes` over a connection of its own and reads until the server closes or `quietMs` pass without a byte;
// {text, isClosed}: all that came, as Latin-1, and whether the server closed. The last request should make it close: a
// short quietMs is for those that nothing is to come of. halfClose: ends the sending side first; oneByOne: each byte
// leaves by itself.
export function sendBytes(port, bytes, { halfClose = false, oneByOne = false, quietMs = 60_000 } = {}) {
  return new Promise((resolve, reject) => {
    const socket = net.connect({ port, host: '127.0.0.1', allowHalfOpen: true });
    const chunks = [];
    const finish = (isClosed) => {
      socket.destroy();
      resolve({ text: Buffer.concat(chunks).toString('latin1'), isClosed });
    };
    socket.setTimeout(quietMs, () => finish(false));
    socket.on('data', (chunk) => chunks.push(chunk));
    socket.on('end', () => finish(true));
    socket.on('error', reject);
    const send = async () => {
      const pieces = oneByOne ? Array.from(Buffer.from(bytes), (byte) => Buffer.from([byte])) : [bytes];
      socket.setNoDelay(oneByOne);
      for (const piece of pieces) await new Promise((sent) => { socket.write(piece, sent); });
      if (halfClose) socket.end();
    };
    socket.once('connect', send);
  });
}

// The status codes of the responses in what sendBytes read. Bodies of this server never hold a line "HTTP/1.1 NNN".
export const statusesOf = (text) => [...text.matchAll(/HTTP\/1\.1 (\d{3}) /g)].map((match) => Number(match[1]));

// Runs the `tilelight` command; {code, stdout (Buffer), stderr}.
export function tilelight(...args) {
  return new Promise((resolve) => {
    execFile(process.env.TILELIGHT, args, { encoding: 'buffer', maxBuffer: 1 << 30 }, (error, stdout, stderr) => {
      resolve({ code: error ? error.code : 0, stdout, stderr: stderr.toString() });
    });
  });
}

// The light that `render FILE --pixel x,y` explains.
export async function explainPixel(name, x = 0, y = 0) {
  const { code, stdout, stderr } = await tilelight('render', inputPath(name), '--pixel', `${x},${y}`);
  if (code !== 0) throw new Error(stderr);
  return JSON.parse(stdout);
}

// Runs tilelightd to its end, which its configuration or its flags are to bring about; {code, stdout, stderr}: code
// null where it had to be ended after a minute.
export function tilelightd(args, { env = {} } = {}) {
  return new Promise((resolve) => {
    execFile(process.env.TILELIGHTD, args, { env: { ...process.env, ...env }, timeout: 60_000, killSignal: 'SIGKILL' },
      (error, stdout, stderr) => resolve({ code: error ? error.code : 0, stdout, stderr }));
  });
}

// Runs a line of sh with the two programs as $TILELIGHT and $TILELIGHTD; {code, stdout, stderr}.
export function shell(line, cwd) {
  return new Promise((resolve) => {
    execFile('sh', ['-c', line], { cwd, timeout: 60_000, killSignal: 'SIGKILL' }, (error, stdout, stderr) => {
      resolve({ code: error ? error.code : 0, stdout, stderr });
    });
  });
}

// Sends a document, as text or as what it means, to `path`; the fetch response.
const send = (method) => (server, path, body, headers = {}) => fetch(server.url + path, {
  method, headers: { 'Content-Type': 'application/json', ...headers },
  body: typeof body === 'string' || body instanceof Uint8Array ? body : JSON.stringify(body),
});
export const post = send('POST');
export const put = send('PUT');

// The job at `location`, once it is done.
export async function jobDone(server, location) {
  for (;;) {
    const job = await (await fetch(server.url + location, { headers: { Prefer: 'wait=10' } })).json();
    if (job.state === 'done') return job;
    if (!['queued', 'running'].includes(job.state)) throw new Error(JSON.stringify(job));
  }
}
