// SPDX-License-Identifier: Apache-2.0
// A tilelightd of its own on free ports, for tests that are written in JavaScript.
import { spawn } from 'node:child_process';
import net from 'node:net';

// A port that nobody has now.
export function freePort() {
  return new Promise((resolve) => {
    const probe = net.createServer().listen(0, '127.0.0.1', () => {
      const { port } = probe.address();
      probe.close(() => resolve(port));
    });
  });
}

// Starts the server with further `flags`; {url, port, adminPort, output(), isAlive(), stop()}. The promise fails with the
// server's output where it ends before it listens.
export async function startServer(flags = []) {
  const server = spawn(process.env.TILELIGHTD, ['--port', '0', '--admin-port', '0',
    '--data-dir', ':memory:', ...flags], { stdio: ['ignore', 'pipe', 'pipe'] });
  const ended = new Promise((resolve) => server.once('exit', resolve));
  let output = '';
  const [url, adminPort] = await new Promise((resolve, reject) => {
    const read = (text) => {
      output += text;
      const announced = /^Tilelight is at (\S+)\/\nHealth and metrics are at \S+:(\d+)\//m.exec(output);
      if (announced) resolve([announced[1], Number(announced[2])]);
    };
    server.stdout.on('data', read);
    server.stderr.on('data', read);
    ended.then((code) => reject(new Error(`The server ended with ${code}:\n${output}`)));
  });
  return {
    url,
    port: Number(new URL(url).port),
    adminPort,
    output: () => output,
    isAlive: () => server.exitCode === null && server.signalCode === null,
    stop: async () => {
      server.kill('SIGTERM');
      return ended;
    },
  };
}
