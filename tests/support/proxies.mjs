// SPDX-License-Identifier: Apache-2.0
// nginx, HAProxy and Varnish on free ports in a folder of their own, by the files of docker/proxies, in which addresses,
// ports, file names and time-outs are replaced and nothing else.
import assert from 'node:assert/strict';
import { execFile, spawn } from 'node:child_process';
import { mkdtemp, mkdir, readFile, rm, writeFile } from 'node:fs/promises';
import net from 'node:net';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { promisify } from 'node:util';
import { freePort } from './server.mjs';

export const kSite = 'render.example';
const kFiles = new URL('../../docker/proxies/', import.meta.url).pathname;
const kPatienceMs = 20_000;

// A file of docker/proxies with each [from, to] replaced, all of which must be there.
export async function configFile(name, replacements) {
  let text = await readFile(kFiles + name, 'utf8');
  for (const [from, to] of replacements) {
    assert.ok(text.includes(from), `${name} says ${from}`);
    text = text.replaceAll(from, to);
  }
  return text;
}

// A certificate for kSite, signed by itself: {cert, key, both}, names of files.
export async function makeCertificate(folder) {
  const [cert, key, both] = ['cert.pem', 'key.pem', 'both.pem'].map((name) => path.join(folder, name));
  await promisify(execFile)('openssl', ['req', '-x509', '-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:prime256v1', '-nodes',
    '-subj', `/CN=${kSite}`, '-addext', `subjectAltName=DNS:${kSite}`, '-days', '2', '-keyout', key, '-out', cert]);
  await writeFile(both, await readFile(cert, 'utf8') + await readFile(key, 'utf8'));
  return { cert, key, both };
}

async function listens(port, program) {
  const until = Date.now() + kPatienceMs;
  for (;;) {
    const isThere = await new Promise((resolve) => {
      const socket = net.connect({ port, host: '127.0.0.1' }, () => { socket.destroy(); resolve(true); });
      socket.on('error', () => resolve(false));
    });
    if (isThere) return;
    if (program.exitCode !== null || Date.now() > until) throw new Error(`${program.spawnfile}:\n${program.output}`);
    await new Promise((resolve) => { setTimeout(resolve, 50); });
  }
}

// Starts a program that serves `port` until stop(); {port, stop()}. The folder goes with it.
async function start(folder, port, program, args) {
  const child = spawn(program, args, { stdio: ['ignore', 'pipe', 'pipe'] });
  child.output = '';
  child.on('error', (error) => { child.output += error; child.exitCode ??= 127; });
  for (const stream of [child.stdout, child.stderr]) stream.on('data', (text) => { child.output += text; });
  const ended = new Promise((resolve) => { child.once('exit', resolve); });
  const stop = async () => {
    if (child.exitCode === null && child.kill('SIGTERM')) await ended;
    await rm(folder, { recursive: true, force: true });
  };
  try {
    await listens(port, child);
  } catch (error) {
    await stop();
    throw error;
  }
  return { port, output: () => child.output, stop };
}

const newFolder = () => mkdtemp(path.join(tmpdir(), 'tilelight-proxy-'));
const kSbin = { env: { ...process.env, PATH: `${process.env.PATH}:/usr/sbin` } };
const find = async (name) => (await promisify(execFile)('sh', ['-c', `command -v ${name}`], kSbin)).stdout.trim();

// nginx with what `site({folder, port})` gives for the inside of its http block.
export async function startNginx(site) {
  const folder = await newFolder();
  const port = await freePort();
  const temporary = ['client_body', 'proxy', 'fastcgi', 'uwsgi', 'scgi']
    .map((kind) => `${kind}_temp_path ${folder}/${kind};`).join(' ');
  const user = process.getuid() === 0 ? 'user root;' : '';  // its workers may enter the folder
  await writeFile(path.join(folder, 'nginx.conf'), `daemon off; ${user} pid nginx.pid; error_log stderr;
events {}
http {
  access_log off; ${temporary}
${await site({ folder, port })}
}
`);
  return start(folder, port, await find('nginx'), ['-p', folder, '-e', 'stderr', '-c', path.join(folder, 'nginx.conf')]);
}

// docker/proxies/nginx.conf before the server on `port`, waiting `timeoutS` for it.
export function startDocumentedNginx(server, timeoutS = 60) {
  return startNginx(async ({ folder, port }) => {
    const { cert, key } = await makeCertificate(folder);
    await mkdir(path.join(folder, 'cache'));
    return configFile('nginx.conf', [
      ['listen 443 ', `listen 127.0.0.1:${port} `], ['127.0.0.1:8080', `127.0.0.1:${server.port}`],
      ['/etc/nginx/tls/render.example.pem', cert], ['/etc/nginx/tls/render.example.key', key],
      ['/var/cache/nginx/tilelight', `${folder}/cache`], ['proxy_read_timeout 60s', `proxy_read_timeout ${timeoutS}s`],
    ]);
  });
}

export async function startDocumentedHaproxy(server, timeoutS = 50) {
  const folder = await newFolder();
  const port = await freePort();
  const { both } = await makeCertificate(folder);
  const file = path.join(folder, 'haproxy.cfg');
  await writeFile(file, await configFile('haproxy.cfg', [
    ['bind :443', `bind 127.0.0.1:${port}`], ['127.0.0.1:8080', `127.0.0.1:${server.port}`],
    ['check port 8081', `check port ${server.adminPort}`], ['/etc/haproxy/tls/render.example.pem', both],
    ['timeout client  50s', `timeout client  ${timeoutS}s`], ['timeout server  50s', `timeout server  ${timeoutS}s`],
  ]));
  return start(folder, port, await find('haproxy'), ['-db', '-f', file]);
}

export async function startDocumentedVarnish(server) {
  const folder = await newFolder();
  const port = await freePort();
  const file = path.join(folder, 'varnish.vcl');
  await writeFile(file, await configFile('varnish.vcl', [['"8080"', `"${server.port}"`]]));
  return start(folder, port, await find('varnishd'), ['-j', 'none', '-F', '-n', folder, '-a', `127.0.0.1:${port}`,
    '-s', 'malloc,32m', '-f', file]);
}

// Varnish with its own rules alone.
export async function startPlainVarnish(server) {
  const folder = await newFolder();
  const port = await freePort();
  return start(folder, port, await find('varnishd'), ['-j', 'none', '-F', '-n', folder, '-a', `127.0.0.1:${port}`,
    '-s', 'malloc,32m', '-b', `127.0.0.1:${server.port}`]);
}
