// SPDX-License-Identifier: Apache-2.0
// HTTP as the standards say it and as real clients speak it: bytes of connections, each with the right answer.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { post, readInput, sendBytes, startServer, statusesOf } from './harness.mjs';

let server;
before(async () => { server = await startServer(['--quiet']); });
after(async () => { assert.equal(await server.stop(), 0); });

const scene = JSON.stringify({ objects: [{ type: 'sphere' }], image: { width: 16, height: 16 }, render: { samples: 1 } });

// A request of these lines, the last one of its connection.
const lastRequest = (line, ...fields) => [line, 'Host: localhost', 'Connection: close', ...fields, '', ''].join('\r\n');
const lastPost = (path, body, ...fields) => lastRequest(`POST ${path} HTTP/1.1`, `Content-Length: ${body.length}`, ...fields) + body;
const kJson = 'Content-Type: application/json';

// The responses in the text, as {status, headers, body}; names of headers in lower case. `heads`: indices of answers to HEAD.
function responsesOf(text, heads = []) {
  const responses = [];
  while (text.startsWith('HTTP/1.1 ')) {
    const end = text.indexOf('\r\n\r\n');
    const [line, ...fields] = text.slice(0, end).split('\r\n');
    const headers = Object.fromEntries(fields.map((field) => [field.slice(0, field.indexOf(':')).toLowerCase(), field.slice(field.indexOf(':') + 1).trim()]));
    const status = Number(line.split(' ')[1]);
    const length = heads.includes(responses.length) || status === 204 || status === 304 ? 0 : Number(headers['content-length'] ?? 0);
    responses.push({ status, headers, body: text.slice(end + 4, end + 4 + length) });
    text = text.slice(end + 4 + length);
  }
  assert.equal(text, '', 'nothing is left over behind the last response');
  return responses;
}

// The only response to these bytes, after which the server closes.
async function ask(bytes, options = {}) {
  const { text, isClosed } = await sendBytes(server.port, bytes);
  assert.ok(isClosed);
  const responses = responsesOf(text, options.isHead ? [0] : []);
  assert.equal(responses.length, 1, text);
  return responses[0];
}
const statusOf = async (...parts) => (await ask(lastRequest(...parts))).status;

test('a client that ends its sending gets its picture', async () => {
  const { text } = await sendBytes(server.port, await readInput('half-close-render.http'), { halfClose: true, quietMs: 300_000 });
  const [response] = responsesOf(text);
  assert.equal(response.status, 200, text.slice(0, 300));
  assert.equal(response.body.slice(1, 4), 'PNG');
  assert.equal(response.body.slice(-8, -4), 'IEND');
});

test('a client that ends its sending gets all its answers, and then the end', async () => {
  const { text, isClosed } = await sendBytes(server.port, await readInput('half-close-pipelined.http'), { halfClose: true });
  assert.deepEqual(responsesOf(text).map(({ status }) => status), [200, 200, 200, 200, 200]);
  assert.ok(isClosed);
});

test('requests that arrive byte by byte are the same requests', async () => {
  const { text, isClosed } = await sendBytes(server.port, await readInput('line-end-after-body.http'), { oneByOne: true });
  assert.deepEqual(responsesOf(text).map(({ status }) => status), [200, 200]);
  assert.ok(isClosed);
});

test('a target may name its host', async () => {
  for (const input of ['target-absolute-form.http', 'target-absolute-form-with-port.http']) {
    assert.equal((await ask(await readInput(input))).status, 200, input);
  }
  for (const target of ['HTTP://LOCALHOST/v1/limits', 'https://localhost/v1/limits', 'http://[::1]:8080/v1/limits', 'http://127.0.0.1', 'http://localhost/?a=b']) {
    assert.equal(await statusOf(`GET ${target} HTTP/1.1`), 200, target);
  }
});

test('the host of the target counts, and not the Host header beside it', async () => {
  const beside = (target, host) => ask(`GET ${target} HTTP/1.1\r\nHost: ${host}\r\nConnection: close\r\n\r\n`);
  assert.equal((await beside('http://localhost/v1/limits', 'other.example')).status, 200);
  assert.equal((await beside('http://other.example/v1/limits', 'localhost')).status, 421);
  assert.equal((await beside('http://user@localhost/v1/limits', 'localhost')).status, 400);
  assert.equal((await ask('GET http://other.example/v1/limits HTTP/1.0\r\n\r\n')).status, 421);
});

test('OPTIONS says what may be done, of the server and of a path', async () => {
  const star = await ask(await readInput('options-asterisk.http'));
  assert.equal(star.status, 204);
  assert.deepEqual(new Set(star.headers.allow.split(', ')), new Set(['GET', 'HEAD', 'POST', 'PUT', 'DELETE', 'OPTIONS']));
  assert.equal(star.headers['content-length'], undefined, 'RFC 9110, 8.6');
  const check = await ask(await readInput('options-http-1.0-check.http'));
  assert.equal(check.status, 204);
  assert.equal(check.headers.allow, 'GET, HEAD, OPTIONS');
  for (const [path, allow] of [['/v1/renders', 'POST, GET, HEAD, OPTIONS'], ['/v1/sessions/x/view', 'PUT, OPTIONS'],
    ['/v1/renders/x', 'GET, HEAD, DELETE, OPTIONS'], ['/index.html', 'GET, HEAD, OPTIONS']]) {
    const response = await ask(lastRequest(`OPTIONS ${path} HTTP/1.1`));
    assert.deepEqual([response.status, response.headers.allow], [204, allow], path);
  }
  assert.equal(await statusOf('OPTIONS /nowhere HTTP/1.1'), 404);
  assert.equal((await ask(lastRequest('HEAD /v1/plan HTTP/1.1'), { isHead: true })).headers.allow, 'POST, OPTIONS');
});

test('close anywhere in Connection closes', async () => {
  for (const input of ['connection-close-capital.http', 'connection-close-in-list.http']) {
    const response = await ask(await readInput(input));
    assert.deepEqual([response.status, response.headers.connection, response.headers['keep-alive']], [200, 'close', undefined], input);
  }
  const two = (fields) => `GET /v1/limits HTTP/1.1\r\nHost: localhost\r\n${fields}\r\n${lastRequest('GET /v1/limits HTTP/1.1')}`;
  for (const [fields, answers] of [['Connection: close\r\n', 1], ['Connection: TE\r\nconnection: CLOSE\r\n', 1], ['Connection: clos%65\r\n', 2], ['Connection: upgrade, HTTP2-Settings\r\nUpgrade: h2c\r\nHTTP2-Settings: AAMAAABk\r\n', 2]]) {
    const { text } = await sendBytes(server.port, two(fields));
    assert.equal(statusesOf(text).length, answers, fields);
  }
});

test('an HTTP/1.0 client gets nothing before it has sent its body', async () => {
  const head = await readInput('expect-http-1.0.http');
  assert.equal((await sendBytes(server.port, head, { quietMs: 500 })).text, '');
  assert.equal((await ask(Buffer.concat([head, Buffer.from('{"objects": [{"type": "sphere"}]}')]))).status, 200);
});

test('an HTTP/1.0 connection stays open where the client asks for it, and the answer says so', async () => {
  const one = await readInput('keep-alive-http-1.0.http');
  const { text } = await sendBytes(server.port, Buffer.concat([one, Buffer.from('GET /v1/limits HTTP/1.0\r\n\r\n')]));
  const twice = await sendBytes(server.port, await readInput('keep-alive-http-1.0-twice.http'));
  for (const responses of [responsesOf(text), responsesOf(twice.text)]) {
    assert.deepEqual(responses.map(({ status }) => status), [200, 200]);
    assert.equal(responses[0].headers.connection.toLowerCase(), 'keep-alive');
    assert.ok(responses[0].headers['keep-alive']);
    assert.equal(responses[1].headers.connection, 'close');
    assert.equal(responses[1].headers['keep-alive'], undefined, 'nothing is promised that is not kept');
  }
});

test('one empty line before a request is ignored', async () => {
  assert.equal((await ask(await readInput('empty-line-before-request.http'))).status, 200);
  const { text } = await sendBytes(server.port, await readInput('line-end-after-body.http'));
  assert.deepEqual(responsesOf(text).map(({ status }) => status), [200, 200]);
  assert.equal((await ask(`\r\n\r\n${lastRequest('GET / HTTP/1.1')}`)).status, 400);
});

test('lines without CR are refused at once', async () => {
  assert.equal((await ask('GET /v1/limits HTTP/1.1\nHost: localhost\n\n')).status, 400);
  assert.equal((await ask('GET /v1/limits HTTP/1.1\r\nHost: localhost\n')).status, 400);
});

test('every answer has a Date, and 100 has none', async () => {
  const etag = (await ask(lastRequest('GET /v1/limits HTTP/1.1'))).headers.etag;
  const requests = [
    ['GET / HTTP/1.1'], ['HEAD / HTTP/1.1'], ['GET /v1/limits HTTP/1.1', `If-None-Match: ${etag}`], ['OPTIONS * HTTP/1.1'], ['GET /nowhere HTTP/1.1'],
    ['PUT / HTTP/1.1'], ['BREW / HTTP/1.1'], ['GET /% HTTP/1.1'], ['GET / HTTP/2.0'], ['GET / HTTP/1.1', 'X: \x01'],
    ['POST /v1/plan HTTP/1.1', 'Transfer-Encoding: chunked'], ['GET /v1/limits HTTP/1.1', 'If-Match: "x"'],
  ];
  const seen = new Set();
  for (const request of requests) {
    const response = await ask(lastRequest(...request), { isHead: request[0].startsWith('HEAD') });
    seen.add(response.status);
    assert.match(response.headers.date ?? '', /^(Mon|Tue|Wed|Thu|Fri|Sat|Sun), \d\d [A-Z][a-z]{2} \d{4} \d\d:\d\d:\d\d GMT$/, request[0]);
    assert.ok(Math.abs(Date.parse(response.headers.date) - Date.now()) < 600_000, 'and it is now');
  }
  assert.deepEqual([...seen].sort(), [200, 204, 304, 400, 404, 405, 411, 412, 501, 505]);
  const head = `POST /v1/plan HTTP/1.1\r\nHost: localhost\r\n${kJson}\r\nExpect: 100-continue\r\nContent-Length: 9\r\n\r\n`;
  assert.equal((await sendBytes(server.port, head, { quietMs: 500 })).text, 'HTTP/1.1 100 Continue\r\n\r\n');
});

test('If-Match is held against the entity tag', async () => {
  const refused = await ask(await readInput('if-match-other-tag.http'));
  assert.equal(refused.status, 412);
  const { etag } = refused.headers;
  const statusWith = (...fields) => statusOf('GET /v1/limits HTTP/1.1', ...fields);
  assert.equal(await statusWith(`If-Match: "x", ${etag}`), 200);
  assert.equal(await statusWith('If-Match: *'), 200);
  assert.equal(await statusWith(`If-Match: W/${etag}`), 412, 'the strong comparison');
  assert.equal(await statusWith(`If-Match: ${etag}`, `If-None-Match: ${etag}`), 304);
  assert.equal(await statusWith('If-Match: "x"', `If-None-Match: ${etag}`), 412, 'If-Match comes first');
  assert.equal(await statusWith('If-Unmodified-Since: Sat, 01 Jan 2000 00:00:00 GMT'), 200, 'ignored where nothing has a date: RFC 9110, 13.1.4');
  assert.equal(await statusOf('GET /nowhere HTTP/1.1', 'If-Match: "x"'), 404, 'conditions count where the answer would be a success');
});

test('If-Match stops what would change something', async () => {
  const { headers } = await ask(lastPost('/v1/renders', scene, kJson));
  assert.equal(await statusOf(`DELETE ${headers.location} HTTP/1.1`, 'If-Match: "x"'), 412);
  assert.equal(await statusOf(`GET ${headers.location} HTTP/1.1`), 200, 'it is still there');
  assert.equal(await statusOf('DELETE /v1/renders/none HTTP/1.1', 'If-Match: "x"'), 404);
  const weak = await ask(lastRequest(`DELETE ${headers.location} HTTP/1.1`, `If-Match: ${(await ask(lastRequest(`GET ${headers.location} HTTP/1.1`))).headers.etag}`));
  assert.equal(weak.status, 412);
  assert.match(weak.body, /a weak one, which If-Match never matches/);
  assert.equal((await ask(lastPost('/v1/scenes', scene, kJson, 'If-Match: "x"'))).status, 412);
  assert.equal(await statusOf(`DELETE ${headers.location} HTTP/1.1`, 'If-Match: *'), 204);
});

test('a picture that is not wanted by its tag is not rendered', async () => {
  const { headers } = await ask(lastPost('/v1/scenes', scene, kJson));
  const refused = await ask(lastRequest(`GET ${headers.location}/image HTTP/1.1`, 'If-Match: "x"'));
  assert.equal(refused.status, 412);
  const picture = await ask(lastRequest(`GET ${headers.location}/image HTTP/1.1`, `If-Match: ${refused.headers.etag}`));
  assert.equal(picture.status, 200);
  assert.equal(picture.headers.etag, refused.headers.etag);
});

test('a coded body is refused with the codings that are taken', async () => {
  for (const coding of ['gzip', 'identity, br', 'GZIP']) {
    const response = await ask(lastPost('/v1/plan', scene, kJson, `Content-Encoding: ${coding}`));
    assert.deepEqual([response.status, response.headers['accept-encoding']], [415, 'identity'], coding);
  }
  assert.equal((await ask(lastPost('/v1/plan', scene, kJson, 'Content-Encoding: identity'))).status, 200);
});

test('percent signs in header values mean nothing', async () => {
  const job = async (key) => (await ask(lastPost('/v1/renders', scene, kJson, `Idempotency-Key: ${key}`))).headers.location;
  const keys = ['abc', 'a%62c', '%61%62%63', 'a%2562c'];
  const jobs = await Promise.all(keys.map(job));
  assert.equal(new Set(jobs).size, keys.length, 'each key is one of its own');
  assert.equal(await job('a%62c'), jobs[1], 'and finds its job again');
  assert.equal((await ask(lastPost('/v1/plan', scene, 'Content-Type: application%2Fjson'))).status, 415);
  assert.equal((await ask('GET / HTTP/1.1\r\nHost: localhos%74\r\nConnection: close\r\n\r\n')).status, 421);
  assert.equal(await statusOf('GET / HTTP/1.1', 'X: %0d%0aSet-Cookie: a=b'), 200);
  const { headers } = await ask(lastPost('/v1/renders', scene, kJson, 'Prefer: wait=1%30, respond-async', 'Accept: image%2Fpng, application/json'));
  assert.equal(headers['preference-applied'], 'respond-async');
  const tag = (await ask(lastRequest('GET /v1/limits HTTP/1.1'))).headers.etag;
  assert.equal(await statusOf('GET /v1/limits HTTP/1.1', `If-None-Match: ${tag.replaceAll('"', '%22')}`), 200);
});

test('values with line ends in percent signs split no answer', async () => {
  for (const field of ['Idempotency-Key', 'Host', 'X-Request-Id', 'Last-Event-ID', 'Prefer', 'Content-Type', 'Origin']) {
    const lines = field === 'Host' ? ['Host: localhost%0d%0aEvil: yes'] : ['Host: localhost', `${field}: a%0d%0aEvil: yes`];
    const response = await ask(['POST /v1/renders HTTP/1.1', ...lines, 'Connection: close', `Content-Length: ${scene.length}`, '', scene].join('\r\n'));
    assert.equal(response.headers.evil, undefined, field);
  }
});

test('fields that may come once and come twice are refused', async () => {
  for (const field of ['Content-Length: 0', 'Host: localhost', 'Origin: http://localhost', kJson, 'Idempotency-Key: a']) {
    const twice = field.startsWith('Host') ? [field] : [field, field];
    assert.equal(await statusOf('POST /v1/plan HTTP/1.1', ...twice), 400, field);
  }
});

test('an encoded separator is data of its segment', async () => {
  for (const path of ['/v1%2Flimits', '/v1%2flimits', '/v1%252Flimits', '/v1/%2Flimits', '/%2Fv1/limits', '/js%2Fmain.js', '/v1/limits%3F', '/v1/limits%23', '//v1/limits',
    '/v1//limits', '/v1/limits/', '/v1/./limits', '/v1/../v1/limits', '/v1/%2e%2e/v1/limits', '/v1/limits;a=b', '/v1/limits%00', '/v1/limits%20', '/v1/limits+', '/V1/limits', '/index.html/', '//']) {
    assert.equal(await statusOf(`GET ${path} HTTP/1.1`), 404, path);
  }
  for (const path of ['/%761/limits', '/v1/l%69m%69ts', '/%6As/main.js', '/%69ndex.html']) {
    assert.equal(await statusOf(`GET ${path} HTTP/1.1`), 200, path);
  }
  const { headers } = await ask(lastPost('/v1/renders', scene, kJson));
  const id = headers.location.slice('/v1/renders/'.length);
  assert.equal(await statusOf(`GET /v1/renders/%${id.charCodeAt(0).toString(16)}${id.slice(1)} HTTP/1.1`), 200);
  assert.equal(await statusOf(`GET /v1/renders/${id}%2Freport HTTP/1.1`), 404);
  assert.equal(await statusOf(`GET /v1/renders/${id}%252Freport HTTP/1.1`), 404);
  assert.equal(await statusOf(`DELETE /v1/renders/${id}%2F HTTP/1.1`), 404);
});

test('a % that encodes nothing is refused', async () => {
  for (const target of ['/%', '/%zz', '/v1/renders/%4', '/?a=%', '/?%zz=1', '/v1/limits?%2', '/%u0041']) {
    assert.equal(await statusOf(`GET ${target} HTTP/1.1`), 400, target);
  }
});

test('a query may hold a question mark', async () => {
  assert.equal(await statusOf('GET /?a=b?c HTTP/1.1'), 200);
  const response = await ask(lastRequest('GET /v1/renders?state=a?b HTTP/1.1'));
  assert.match(response.body, /state must be/);
});

test('parameters that a route does not know, and repeated ones, are refused by name', async () => {
  const { headers } = await ask(lastPost('/v1/renders', scene, kJson));
  const { headers: stored } = await ask(lastPost('/v1/scenes', scene, kJson));
  const refusedAs = async (line, ...fields) => {
    const response = await ask(lastRequest(line, ...fields));
    assert.equal(response.status, 422, line);
    return JSON.parse(response.body).errors.map(({ pointer, code, hint }) => [pointer, code, hint].filter(Boolean).join(' '));
  };
  const job = headers.location;
  for (const path of ['/v1/renders', job, `${job}/image`, `${job}/report`, `${job}/pixel`, `${job}/events`, stored.location, `${stored.location}/plan`, `${stored.location}/image`,
    '/v1/sessions/x/frame', '/v1/limits', '/v1/schema/scene.json', '/openapi.json']) {
    assert.deepEqual(await refusedAs(`GET ${path}?bogus=1 HTTP/1.1`), ['/bogus unknown_key'], path);
  }
  for (const path of ['/v1/renders', '/v1/scenes', '/v1/plan', '/v1/sessions', `${job}/refine`]) assert.deepEqual(await refusedAs(`POST ${path}?bogus HTTP/1.1`), ['/bogus unknown_key'], path);
  assert.deepEqual(await refusedAs(`DELETE ${job}?force=1 HTTP/1.1`), ['/force unknown_key']);
  assert.equal(await statusOf(`GET ${job} HTTP/1.1`), 200, 'nothing was deleted');
  assert.deepEqual(await refusedAs('GET /v1/renders?limit=5&limit=6 HTTP/1.1'), ['/limit duplicate_key']);
  assert.deepEqual(await refusedAs('GET /v1/renders?limit=5&l%69mit=5 HTTP/1.1'), ['/limit duplicate_key']);
  assert.deepEqual(await refusedAs('GET /v1/renders?limi=5&stat=done HTTP/1.1'), ['/limi unknown_key did you mean "limit"?', '/stat unknown_key did you mean "state"?']);
  assert.deepEqual(await refusedAs(`GET ${job}/image?partial=1&Layer=error HTTP/1.1`), ['/Layer unknown_key did you mean "layer"?']);
  assert.deepEqual(await refusedAs('GET /v1/limits?a=b?c HTTP/1.1'), ['/a unknown_key'], 'and not as a malformed target');
  assert.equal(await statusOf(`GET ${job}/image?partial=yes HTTP/1.1`), 400);
  assert.equal(await statusOf('GET /v1/renders?&limit=5& HTTP/1.1'), 200, 'empty pairs are none');
});

test('the page is served whatever its query says', async () => {
  for (const target of ['/?utm_source=x&utm_source=y', '/js/main.js?v=1234', '/index.html?']) assert.equal(await statusOf(`GET ${target} HTTP/1.1`), 200, target);
});

test('health and metrics come whatever their query says', async () => {
  for (const target of ['/livez?verbose', '/readyz?verbose=1&verbose=1', '/metrics?format=prometheus', '/version?']) {
    assert.equal((await fetch(`http://127.0.0.1:${server.adminPort}${target}`)).status, 200, target);
  }
});

test('a + in a query is a blank, and the refusal of a number says so', async () => {
  const { headers } = await ask(lastPost('/v1/scenes', scene, kJson));
  assert.equal(await statusOf(`GET ${headers.location}/image?exposure=1e%2B0 HTTP/1.1`), 200);
  const refused = await ask(lastRequest(`GET ${headers.location}/image?exposure=1e+0 HTTP/1.1`));
  assert.equal(refused.status, 422);
  assert.match(refused.body, /%2B/);
});

test('of two waits the first counts, and parameters of preferences are none', async () => {
  const slow = JSON.stringify({ image: { width: 2048, height: 2048 }, render: { samples: 4096 }, objects: [{ type: 'sphere' }] });
  for (const [prefer, applied] of [['wait=0, wait=30', 'wait=0'], ['wait=0; x="y,wait=30"', 'wait=0'], ['WAIT = "0"', 'wait=0'], ['respond-async; x', 'respond-async'], ['foo; wait=30, wait=0', 'wait=0'], ['respond-async, wait=0', 'respond-async, wait=0']]) {
    const response = await ask(lastPost('/v1/renders', slow, kJson, 'Accept: image/png', `Prefer: ${prefer}`));
    assert.deepEqual([response.status, response.headers['preference-applied']], [202, applied], prefer);
    assert.equal(await statusOf(`DELETE ${response.headers.location} HTTP/1.1`), 204);
  }
  const brief = await ask(lastPost('/v1/renders', slow, kJson, 'Accept: image/png', 'Prefer: wait=0.25'));
  assert.equal(brief.headers['preference-applied'], 'wait=0.25', 'with its decimals');
  assert.equal(await statusOf(`DELETE ${brief.headers.location} HTTP/1.1`), 204);
  const waited = await ask(lastPost('/v1/renders', scene, kJson, 'Accept: image/png', 'Prefer: respond-async, wait=30'));
  assert.equal(waited.status, 200, 'with both, a job is the answer only where the wait runs out: RFC 7240, 4.3');
});

test('a HEAD is never answered with a body', async () => {
  for (const [line, ...fields] of [['HEAD / HTTP/1.1'], ['HEAD /nowhere HTTP/1.1'], ['HEAD /v1/plan HTTP/1.1'], ['HEAD /% HTTP/1.1'], ['HEAD / HTTP/1.1', 'X : y'], ['HEAD / HTTP/1.1', 'Transfer-Encoding: chunked'],
    ['HEAD / HTTP/1.1', `Content-Length: ${1 << 30}`], ['HEAD /v1/limits?x HTTP/1.1'], [`HEAD /${'a'.repeat(5000)} HTTP/1.1`]]) {
    const response = await ask(lastRequest(line, ...fields), { isHead: true });
    assert.equal(response.body, '', line);
  }
});

test('after an answer that is an error the connection goes on', async () => {
  const get = (target, ...fields) => [`GET ${target} HTTP/1.1`, 'Host: localhost', ...fields, '', ''].join('\r\n');
  const bad = `POST /v1/plan HTTP/1.1\r\nHost: localhost\r\n${kJson}\r\nContent-Length: 3\r\n\r\n{x}`;
  const { text } = await sendBytes(server.port, get('/nowhere') + get('/v1/limits?x') + bad + get('/v1/limits', 'If-Match: "x"') + get('/v1/limits', 'Host: localhost') + get('/v1/limits'));
  assert.deepEqual(responsesOf(text).map(({ status }) => status), [404, 422, 400, 412, 400], 'what is no request ends it');
});

test('what looks like another protocol is refused', async () => {
  for (const bytes of ['PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n', '\x16\x03\x01\x02\x00\x01\r\n\r\n', 'GET\r\n\r\n', 'HELO example\r\n\r\n', '{}\n']) {
    assert.ok([400, 505].includes((await ask(Buffer.from(bytes, 'latin1'))).status), bytes);
  }
});

test('fetch and its keep-alive work', async () => {
  const responses = await Promise.all(Array.from({ length: 20 }, () => post(server, '/v1/renders', scene, { Accept: 'image/png' })));
  for (const response of responses) assert.equal(response.status, 200);
});
