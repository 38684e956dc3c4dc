// SPDX-License-Identifier: Apache-2.0
// A client that sends the header fields of a browser, which fetch() would not, and keeps a transcript.
import http from 'node:http';
import http2 from 'node:http2';
import https from 'node:https';
import tls from 'node:tls';
import { kSite } from '../support/proxies.mjs';

const kShown = ['location', 'link', 'preference-applied', 'cache-control', 'vary', 'age'];

// Speaks to 127.0.0.1:port, for the site `host` by TLS or, without one, plainly. `from`: the client's own address.
// `say` gets a line an exchange.
export class Client {
  constructor({ port, host, from = '127.0.0.1', say = () => {} }) {
    this.host = host && `${host}:${port}`;
    this.origin = host ? `https://${this.host}` : `http://127.0.0.1:${port}`;
    this.port = port;
    this.from = from;
    this.say = say;
  }

  // {status, headers, body (Buffer)}.
  async ask(method, path, { headers = {}, body } = {}) {
    const response = await this.open(method, path, { headers, body });
    const chunks = [];
    for await (const chunk of response) chunks.push(chunk);
    const answer = { status: response.statusCode, headers: response.headers, body: Buffer.concat(chunks) };
    const shown = kShown.filter((name) => name in answer.headers).map((name) => ` | ${name}: ${answer.headers[name]}`);
    const sent = Object.entries(headers).map(([name, value]) => ` | ${name}: ${value}`).join('');
    this.say(`${method} ${path}${sent}  ->  ${answer.status}, ${answer.body.length} bytes${shown.join('')}`);
    return answer;
  }

  // The response as it comes.
  open(method, path, { headers = {}, body } = {}) {
    const isJson = body !== undefined;
    const options = {
      host: '127.0.0.1', port: this.port, localAddress: this.from, method, path, agent: false,
      headers: {
        ...(this.host ? { Host: this.host } : {}), ...(isJson ? { 'Content-Type': 'application/json' } : {}), ...headers,
      },
      ...(this.host ? { servername: kSite, rejectUnauthorized: false } : {}),
    };
    return new Promise((resolve, reject) => {
      const request = (this.host ? https : http).request(options, resolve);
      request.on('error', reject);
      request.end(isJson ? JSON.stringify(body) : undefined);
    });
  }

  async json(method, path, options) {
    return JSON.parse((await this.ask(method, path, options)).body);
  }
}

// The status of a request by HTTP/2, which has no Host field but :authority. As browsers do, it says how long the body is:
// a proxy that does not know passes it on in chunks, which the server takes from nobody.
export function statusByHttp2({ origin, port }, method, path, headers, body) {
  return new Promise((resolve, reject) => {
    const session = http2.connect(origin, {
      createConnection: () => tls.connect({ host: '127.0.0.1', port, servername: kSite, ALPNProtocols: ['h2'], rejectUnauthorized: false }),
    });
    session.on('error', reject);
    const bytes = Buffer.from(JSON.stringify(body));
    const request = session.request({
      ':method': method, ':path': path, 'content-type': 'application/json', 'content-length': bytes.length, ...headers,
    });
    request.on('response', (answer) => {
      resolve(answer[':status']);
      session.destroy();
    });
    request.on('error', reject);
    request.end(bytes);
  });
}

// The value of a metric, by name and labels as printed; 0 where there is none.
export async function metric(server, sample) {
  const text = await (await fetch(`http://127.0.0.1:${server.adminPort}/metrics`)).text();
  const line = text.split('\n').find((it) => it.startsWith(`${sample} `));
  return line ? Number(line.slice(sample.length + 1)) : 0;
}
