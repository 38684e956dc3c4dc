// SPDX-License-Identifier: Apache-2.0
// Which pages are the server's own, as browsers and proxies write it down (RFC 6454, 4 and 6.2; Fetch Metadata), and what
// a request that waits is told before a proxy gives up on it.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { post, readInput, readJson, sendBytes, startServer, statusesOf } from './harness.mjs';

let server;
let proxied;  // believes proxies on 127.0.0.1
before(async () => {
  server = await startServer(['--allowed-hosts', 'render.example']);
  proxied = await startServer(['--allowed-hosts', 'render.example', '--trusted-proxy', '127.0.0.1', '--max-wait-s', '1']);
});
after(async () => {
  await server?.stop();
  await proxied?.stop();
});

const kBody = '{"objects": [{"type": "sphere"}]}';

// The status of a POST to /v1/plan with these header fields.
async function statusOf(fields, to = server) {
  const head = fields.map(([name, value]) => `${name}: ${value}\r\n`).join('');
  const { text } = await sendBytes(to.port, `POST /v1/plan HTTP/1.1\r\n${head}Content-Type: application/json\r\nContent-Length: ${kBody.length}\r\nConnection: close\r\n\r\n${kBody}`);
  return statusesOf(text)[0];
}
const from = (host, origin, ...more) => [['Host', host], ['Origin', origin], ...more];

for (const [what, file, status] of [
  ['a page behind proxy_pass alone, of which the browser says that it is of the same site', 'origin_behind_bare_proxy_pass.http', 202],
  ['a page of https where the proxy writes port 443 out in Host', 'origin_where_host_writes_port_443_out.http', 202],
  ['a page of http where Host has port 80 written out', 'origin_where_host_writes_port_80_out.http', 200],
]) {
  test(`${what} may change something`, async () => {
    const { text } = await sendBytes(server.port, await readInput(file));
    assert.deepEqual(statusesOf(text), [status]);
  });
}

test('a port left out is the port of the scheme, in Host and in Origin', async () => {
  for (const [host, origin] of [
    ['render.example', 'https://render.example'], ['render.example', 'http://render.example'],
    ['render.example:443', 'https://render.example:443'], ['render.example', 'https://render.example:443'],
    ['render.example:80', 'http://render.example:80'], ['render.example:8443', 'https://render.example:8443'],
    ['RENDER.example', 'https://render.EXAMPLE'], ['render.example:', 'http://render.example'],
    ['[::1]:443', 'https://[::1]'], ['[::1]', 'http://[0:0::1]:80'], ['192.0.2.7:80', 'http://192.0.2.7'],
  ]) assert.equal(await statusOf(from(host, origin)), 200, `${host} ${origin}`);
});

test('another name, scheme or port is another origin', async () => {
  for (const [host, origin] of [
    ['render.example:80', 'https://render.example'], ['render.example:443', 'http://render.example'],
    ['render.example', 'https://render.example:8443'], ['render.example:8443', 'https://render.example'],
    ['localhost:8080', 'http://localhost:3000'], ['localhost:8080', 'http://127.0.0.1:8080'],
    ['render.example', 'https://render.example.evil.example'], ['render.example', 'https://evil.example/render.example'],
    ['render.example', 'https://user@render.example'], ['render.example', 'render.example'],
    ['render.example', 'ftp://render.example'], ['render.example', 'null'],
    ['render.example', 'https://render.example https://render.example'], ['render.example:80', 'http://render.example:080x'],
    ['render.example', 'https://render.example:99999'], ['render.example', 'https://'],
  ]) assert.equal(await statusOf(from(host, origin)), 403, `${host} ${origin}`);
});

test('what the browser says of the site decides, and no other header can outvote it', async () => {
  const site = (value) => ['Sec-Fetch-Site', value];
  for (const own of ['same-origin', 'none']) assert.equal(await statusOf(from('127.0.0.1:1', 'https://any.example', site(own))), 200);
  const host = 'render.example';
  for (const other of ['cross-site', 'same-site', 'Same-Origin', 'same-origin, cross-site', 'unheard-of']) {
    assert.equal(await statusOf(from(host, `https://${host}`, site(other))), 403, other);
    assert.equal(await statusOf([['Host', host], site(other)]), 403, `${other}, without Origin`);
  }
  assert.equal(await statusOf(from(host, `https://${host}`, site('same-origin'), site('cross-site'))), 403, 'two of them');
  // Of two Origins each reader would take another one: that is no request at all, whatever they say.
  assert.equal(await statusOf(from(host, `https://${host}`, ['Origin', 'https://evil.example'])), 400, 'two origins');
});

test('a name that was bound anew to our address is refused whatever the browser says', async () => {
  const rebound = from('evil.example', 'http://evil.example', ['Sec-Fetch-Site', 'same-origin']);
  assert.equal(await statusOf(rebound), 421);
  assert.equal(await statusOf([...rebound, ['X-Forwarded-Host', 'render.example']], proxied), 421, 'a page may set X-Forwarded-Host');
  assert.equal(await statusOf(from('render.example', 'http://x.example', ['X-Forwarded-Host', 'x.example']), proxied), 421);
});

test('a Host that none can be is 400, one that is not ours 421', async () => {
  for (const host of ['render.example:http', 'render.example:70000', '[::1', '[render.example]', 'user@render.example', 'a b', ':80']) {
    assert.equal(await statusOf([['Host', host]]), 400, host);
  }
  for (const host of ['evil.example', 'render.example.evil.example', '127.0.0.1.evil.example', '[::1].evil.example']) {
    const status = await statusOf([['Host', host]]);
    assert.ok(status === 421 || status === 400, host);
  }
  for (const host of ['localhost.', 'LOCALHOST:1', 'render.example.', '[::ffff:127.0.0.1]:80']) assert.equal(await statusOf([['Host', host]]), 200, host);
});

test('the scheme and the host that a trusted proxy tells are the ones that count', async () => {
  const told = (proto, host) => [['X-Forwarded-Proto', proto], ['X-Forwarded-Host', host]];
  const https = from('127.0.0.1:8080', 'https://render.example', ...told('https', 'render.example'));
  assert.equal(await statusOf(https, proxied), 200);
  assert.equal(await statusOf(https), 403, 'and from nobody else');
  assert.equal(await statusOf(from('render.example', 'https://render.example:8443', ...told('https', 'render.example:8443')), proxied), 200);
  assert.equal(await statusOf(from('render.example', 'http://render.example', ...told('https', 'render.example')), proxied), 403);
  assert.equal(await statusOf(from('render.example', 'https://render.example', ...told('HTTPS', 'bad host')), proxied), 200, 'what is no host is not believed');
});

test('a request that would wait for a minute is given a job after the longest wait, and is told which wait that was', async () => {
  const scene = await readJson('render_of_minutes.json');
  const answer = await post(proxied, '/v1/renders', scene, { Accept: 'image/png', Prefer: 'wait=60' });
  assert.equal(answer.status, 202);
  assert.equal(answer.headers.get('Preference-Applied'), 'wait=1');
  const job = proxied.url + answer.headers.get('Location');
  assert.equal((await (await fetch(job)).json()).state, 'running');
  assert.equal((await fetch(job, { method: 'DELETE' })).status, 204);
  assert.equal((await (await fetch(`${proxied.url}/v1/limits`)).json()).server.max_wait_s, 1);
  assert.equal((await (await fetch(`${server.url}/v1/limits`)).json()).server.max_wait_s, 40, 'under the 50 and 60 seconds of proxies');
});
