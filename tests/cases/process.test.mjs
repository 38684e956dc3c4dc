// SPDX-License-Identifier: Apache-2.0
// Nothing that a client, a scene, a file or an unread pipe holds ends the programs, makes them hang, or is lost in
// silence.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { closeSync, existsSync, mkdirSync, openSync, readSync, readdirSync, writeFileSync } from 'node:fs';
import { mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';

import { freePort, inputPath, jobDone, post, readJson, sendBytes, shell, startServer, tilelight, tilelightd } from './harness.mjs';

let folder;
before(async () => { folder = await mkdtemp(join(tmpdir(), 'tilelight-process-')); });
after(() => rm(folder, { recursive: true }));
const file = (name, bytes) => {
  writeFileSync(join(folder, name), bytes);
  return join(folder, name);
};

const line = (width, height, more = {}) => ({ image: { width, height, ...more.image }, render: { samples: 1 },
  objects: [{ type: 'sphere' }], ...more.scene });

// Width and height of a JPEG, by its start of frame.
function jpegSize(bytes) {
  let at = 2;
  while (bytes[at] === 0xff && (bytes[at + 1] < 0xc0 || bytes[at + 1] > 0xc2)) at += 2 + bytes.readUInt16BE(at + 2);
  return [bytes.readUInt16BE(at + 7), bytes.readUInt16BE(at + 5)];
}
const pngSize = (bytes) => [bytes.readUInt32BE(16), bytes.readUInt32BE(20)];
const bytesOf = async (answer) => Buffer.from(await answer.arrayBuffer());

// The types of an EXR's channels: 1 half, 2 float (OpenEXR File Layout, "chlist").
function exrChannelTypes(bytes) {
  let at = bytes.indexOf('channels\0chlist\0') + 16 + 4;
  const types = {};
  while (bytes[at] !== 0) {
    const end = bytes.indexOf(0, at);
    types[bytes.toString('latin1', at, end)] = bytes.readInt32LE(end + 1);
    at = end + 1 + 16;
  }
  return types;
}

describe('a picture that a format cannot hold', () => {
  let server;
  before(async () => { server = await startServer(); });
  after(async () => { assert.equal(await server.stop(), 0); });

  // The limit of JPEG is told, and the server is still there.
  async function expectRefused(answer, status) {
    assert.equal(answer.status, status);
    assert.match(answer.headers.get('content-type'), /problem\+json/);
    const problem = await answer.json();
    assert.match(problem.detail, /65500/);
    assert.equal((await fetch(`${server.url}/v1/limits`)).status, 200);
    assert.ok(server.isAlive());
    return problem;
  }

  test('is refused where only JPEG is accepted, and the server lives', async () => {
    const scene = await readJson('jpeg-65501-wide.json');
    await expectRefused(await post(server, '/v1/renders', scene, { Accept: 'image/jpeg' }), 406);
    await expectRefused(await post(server, '/v1/renders', line(1, 65501), { Accept: 'image/jpeg' }), 406);
    await expectRefused(await post(server, '/v1/renders', line(65537, 255), { Accept: 'image/jpeg' }), 406);
    await expectRefused(
      await post(server, '/v1/renders', scene, { Accept: 'image/jpeg, text/html', 'Idempotency-Key': 'a' }), 406);
  });

  test('is another that the client accepts', async () => {
    for (const accept of ['image/jpeg, image/png;q=0.5', 'image/jpeg, image/*;q=0.1', 'image/jpeg, */*;q=0.1',
      'image/*', 'image/jpeg, application/json;q=0.1, image/png;q=0.2']) {
      const answer = await post(server, '/v1/renders', line(65501, 1), { Accept: accept });
      assert.equal(answer.status, 200, accept);
      assert.equal(answer.headers.get('content-type'), 'image/png', accept);
      assert.deepEqual(pngSize(await bytesOf(answer)), [65501, 1]);
    }
    const exr = await post(server, '/v1/renders', line(65501, 1), { Accept: 'image/jpeg;q=0.9, image/x-exr;q=0.8' });
    assert.equal(exr.headers.get('content-type'), 'image/x-exr');
    const job = await post(server, '/v1/renders', line(65501, 1), { Accept: 'image/jpeg, application/json;q=0.5' });
    assert.equal(job.status, 202);
  });

  test('is a JPEG up to the last pixel that one can have', async () => {
    for (const [width, height] of [[65500, 1], [1, 65500], [65500, 256]]) {
      const answer = await post(server, '/v1/renders', line(width, height), { Accept: 'image/jpeg' });
      assert.equal(answer.status, 200);
      assert.deepEqual(jpegSize(await bytesOf(answer)), [width, height]);
    }
  });

  test('is no format of a job', async () => {
    const body = { scene: line(65501, 1), format: 'jpeg' };
    const problem = await expectRefused(await post(server, '/v1/renders', body), 422);
    assert.equal(problem.errors[0].pointer, '/format');
    assert.equal(problem.errors[0].code, 'format_limit');
    assert.deepEqual(problem.errors[0].allowed, ['png', 'exr']);
    await expectRefused(await post(server, '/v1/plan', body), 422);
    assert.equal((await post(server, '/v1/renders', { ...body, format: 'png' })).status, 202);
  });

  test('is neither that of a job, whole or partial or its error, nor of a scene, nor what a job is refined to', async () => {
    const job = (await post(server, '/v1/renders', line(65501, 1, { scene: { render: { samples: 4 } } }))).headers
      .get('location');
    const jpeg = { headers: { Accept: 'image/jpeg' } };
    await expectRefused(await fetch(`${server.url}${job}/image?partial=1`, jpeg), 406);
    await jobDone(server, job);
    for (const query of ['', '?partial=1', '?layer=error'])
      await expectRefused(await fetch(`${server.url}${job}/image${query}`, jpeg), 406);
    const png = await fetch(`${server.url}${job}/image?layer=error`);
    assert.equal(png.headers.get('content-type'), 'image/png');
    await expectRefused(await post(server, `${job}/refine`, { samples: 8, format: 'jpeg' }), 422);
    await expectRefused(await post(server, `${job}/refine`, { samples: 8 }, { Accept: 'image/jpeg' }), 406);

    const scene = (await post(server, '/v1/scenes', line(32, 32))).headers.get('location');
    const image = `${server.url}${scene}/image?width=65501&height=1`;
    await expectRefused(await fetch(image, jpeg), 406);
    for (const accept of ['*/*', 'image/avif,image/webp,image/jpeg,image/*;q=0.8']) {
      const answer = await fetch(image, { headers: { Accept: accept } });
      assert.equal(answer.headers.get('content-type'), 'image/png');
      assert.deepEqual(pngSize(await bytesOf(answer)), [65501, 1]);
    }
  });

  test("is no frame of a session", async () => {
    const session = (await post(server, '/v1/sessions', line(65501, 1))).headers.get('location');
    const frame = (accept) => fetch(`${server.url}${session}/frame`, { headers: { Accept: accept } });
    await expectRefused(await frame('image/jpeg'), 406);
    assert.equal((await frame('image/jpeg, image/png;q=0.1')).headers.get('content-type'), 'image/png');
  });

  test('can be known beforehand', async () => {
    const limits = await (await fetch(`${server.url}/v1/limits`)).json();
    assert.equal(limits.formats.jpeg.image_side, 65500);
    for (const format of ['png', 'exr', 'svg']) assert.equal(limits.formats[format].image_side, limits.image_side);
  });

  test('is refused by the command before it renders, and no file is left', async () => {
    const here = join(folder, 'command');
    mkdirSync(here);
    const scene = inputPath('jpeg-65501-wide.json');
    for (const args of [['-o', join(here, 'a.jpg')], ['-o', join(here, 'a.png'), '--error-map', join(here, 'b.jpeg')]]) {
      const { code, stderr } = await tilelight('render', scene, ...args);
      assert.equal(code, 2);
      assert.match(stderr, /^tilelight: .*65500/);
    }
    assert.deepEqual(readdirSync(here), []);
    assert.equal((await tilelight('render', scene, '-o', join(here, 'a.png'))).code, 0);
    assert.equal((await tilelight('render', scene, '-o', join(here, 'a.jpg'), '--width', '65500')).code, 0);
    assert.deepEqual(readdirSync(here).sort(), ['a.jpg', 'a.png']);
  });
});

describe('linear values over 65,504, where half floats end', () => {
  test('stay in an EXR, which has float channels', async () => {
    const server = await startServer();
    const answer = await post(server, '/v1/renders', line(8, 8), { Accept: 'image/x-exr' });
    assert.deepEqual(exrChannelTypes(await bytesOf(answer)), { B: 2, G: 2, R: 2 });
    await server.stop();
    const out = join(folder, 'error.exr');
    const { code, stderr } = await tilelight('render', file('line.json', JSON.stringify(line(8, 8))), '-o',
      join(folder, 'line.exr'), '--error-map', out, '--samples', '4');
    assert.equal(code, 0, stderr);
    assert.ok(existsSync(out));
  });

  test('are told where not even a float can hold them', async () => {
    const server = await startServer();
    const scene = line(8, 8, { image: { exposure: 1000 } });
    const exr = await post(server, '/v1/renders', scene, { Accept: 'image/x-exr' });
    const told = Number(/clamped=(\d+)/.exec(exr.headers.get('render-info'))?.[1]);
    assert.ok(told > 0 && told <= 8 * 8 * 3, exr.headers.get('render-info'));
    const png = await post(server, '/v1/renders', scene, { Accept: 'image/png' });
    assert.doesNotMatch(png.headers.get('render-info'), /clamped/);
    const job = (await post(server, '/v1/renders', { scene, format: 'exr' })).headers.get('location');
    const status = await jobDone(server, job);
    assert.equal(status.report.clamped, told);
    assert.deepEqual(status.warnings.map((warning) => [warning.pointer, warning.code]), [['/image/exposure', 'clamped']]);
    const pngJob = (await post(server, '/v1/renders', { scene, format: 'png' })).headers.get('location');
    const pngStatus = await jobDone(server, pngJob);
    assert.equal(pngStatus.report.clamped, told, 'what an EXR of it would lose');
    assert.deepEqual(pngStatus.warnings, [], 'and nobody has asked for one');
    await server.stop();

    const path = file('bright.json', JSON.stringify(scene));
    const { code, stderr } = await tilelight('render', path, '-o', join(folder, 'bright.exr'), '--report',
      join(folder, 'bright-report.json'));
    assert.equal(code, 0);
    assert.match(stderr, new RegExp(`bright\\.exr: warning: ${told} values .* 32-bit float`));
    const report = JSON.parse((await shell('cat bright-report.json', folder)).stdout);
    assert.equal(report.clamped, told);
    assert.deepEqual(report.warnings.map((warning) => warning.code), ['clamped']);
    const shown = ['bright.png', '--report', 'shown.json'].map((name) => (name.startsWith('--') ? name : join(folder, name)));
    assert.equal((await tilelight('render', path, '-o', ...shown)).stderr, '');
    const { warnings } = JSON.parse((await shell('cat shown.json', folder)).stdout);
    assert.deepEqual(warnings, [], 'a PNG shows them as white, as it shows all over 1');
  });

  test('are told where the light of one sample is more than a picture can sum', async () => {
    const light = { type: 'point', position: [3, 4, 5], intensity: 1e30, color: [1000, 1000, 1000] };
    const path = file('blinding.json', JSON.stringify(line(8, 8, { scene: { lights: Array(100).fill(light) } })));
    for (const name of ['blinding.png', 'blinding.exr'])
      assert.match((await tilelight('render', path, '-o', join(folder, name))).stderr, /warning: \d+ samples? .*1e34/);
  });
});

describe('standard streams that nobody reads', () => {
  // tilelightd with streams of its own on known ports. stdio: for stdout and stderr.
  async function startSilent(stdio, flags = []) {
    const [port, adminPort] = [await freePort(), await freePort()];
    const daemon = spawn(process.env.TILELIGHTD, ['--port', String(port), '--admin-port', String(adminPort), ...flags],
      { stdio: ['ignore', ...stdio] });
    const ended = new Promise((resolve) => daemon.once('exit', (code, signal) => resolve(code ?? signal)));
    const url = `http://127.0.0.1:${port}`, admin = `http://127.0.0.1:${adminPort}`;
    for (;;) {
      if (await fetch(`${admin}/livez`).then(() => true, () => false)) break;
      assert.equal(daemon.exitCode, null, 'the server ended');
    }
    const metric = async (name) => Number(
      new RegExp(`^${name} (\\S+)$`, 'm').exec(await (await fetch(`${admin}/metrics`)).text())?.[1]);
    return { url, admin, daemon, metric, stop: () => { daemon.kill('SIGTERM'); return ended; } };
  }

  // A pipe that this process keeps open at both ends: it never ends, and is read only by drain().
  async function makePipe(name) {
    const path = join(folder, name);
    await shell(`mkfifo ${name}`, folder);
    const fd = openSync(path, 'r+');
    const reader = openSync(path, 'r');
    return { fd, reader, close: () => { closeSync(fd); closeSync(reader); } };
  }

  async function askThousands(url, count) {
    for (let i = 0; i < count; i += 100) {
      const answers = await Promise.all(Array.from({ length: 100 }, () =>
        fetch(`${url}/${'x'.repeat(400)}`).then((answer) => answer.body.cancel().then(() => answer.status))));
      assert.ok(answers.every((status) => status === 404));
    }
  }

  test('keep no request waiting; what is lost is counted and told, and SIGTERM ends the server', async () => {
    const pipe = await makePipe('log');
    const server = await startSilent(['ignore', pipe.fd]);
    await askThousands(server.url, 10_000);
    assert.equal((await fetch(`${server.admin}/livez`)).status, 200);
    const lost = await server.metric('tilelight_log_lines_dropped_total');
    assert.ok(lost > 0, `${lost} lines of 10,000`);
    // Somebody reads again: the lines that were left, with one that tells of the others.
    let text = '';
    const block = Buffer.alloc(65536);
    const kDropped = /"log_lines_dropped","count":(\d+),/;  // with what follows the number, which may come in two blocks
    while (!kDropped.test(text)) text += block.toString('utf8', 0, readSync(pipe.reader, block));
    const told = Number(kDropped.exec(text)[1]);
    assert.ok(told >= lost && told <= lost + 5, `${told}: those and of the requests since`);
    await askThousands(server.url, 1000);
    assert.equal(await server.stop(), 0);
    pipe.close();
  });

  test('may be one pipe for both, full from the start', async () => {
    const pipe = await makePipe('both');
    await shell('dd if=/dev/zero of=both bs=4096 count=16 oflag=nonblock conv=notrunc 2>/dev/null', folder);
    const server = await startSilent([pipe.fd, pipe.fd]);
    await askThousands(server.url, 500);
    assert.equal((await fetch(`${server.admin}/livez`)).status, 200);
    assert.equal(await server.stop(), 0);
    pipe.close();
  });

  test('may be closed, by the reader or from the start', async () => {
    const gone = await startSilent(['pipe', 'pipe']);
    gone.daemon.stdout.destroy();
    gone.daemon.stderr.destroy();
    await askThousands(gone.url, 500);
    assert.ok(await gone.metric('tilelight_log_lines_dropped_total') > 0);
    assert.equal(await gone.stop(), 0);
    const [port, adminPort] = [await freePort(), await freePort()];
    const { code, stdout } = await shell(`"$TILELIGHTD" --port ${port} --admin-port ${adminPort} >&- 2>&- <&- & pid=$!
      until curl -sS -o out.txt http://127.0.0.1:${port}/v1/limits 2>/dev/null; do kill -0 $pid || exit 3; done
      kill -TERM $pid; wait $pid; echo $?; grep -c image_side out.txt >&2`, folder);
    assert.deepEqual([code, stdout.trim()], [0, '0']);
  });

  test('make the command fail where it could not say what it was asked for', async () => {
    file('scene.json', JSON.stringify(line(8, 8)));
    const full = ['>/dev/full', /No space left/], closed = ['>&-', /Bad file descriptor/];
    for (const [args, [to, why]] of [['schema', full], ['schema', closed], ['--help', full], ['--version', closed],
      ['plan scene.json', full], ['plan scene.json --json', closed], ['render scene.json --pixel 0,0', full],
      ['render scene.json -o x.png --report -', closed], ['chess 8/8/8/8/8/8/8/K1k5 --scene', full]]) {
      const { code, stderr } = await shell(`"$TILELIGHT" ${args} ${to}`, folder);
      assert.equal(code, 1, `${args} ${to}: ${stderr}`);
      assert.match(stderr, /^tilelight: cannot write standard output/m);
      assert.match(stderr, why);
    }
    const onto = await shell('ln -s /dev/full full.png; "$TILELIGHT" render scene.json -o full.png', folder);
    assert.equal(onto.code, 1);
    assert.match(onto.stderr, /^tilelight: cannot write full\.png: No space left/);
    // A file that is opened while standard output is closed is not written into by mistake.
    const { code } = await shell('"$TILELIGHT" render scene.json -o closed.png >&- 2>&- <&-', folder);
    assert.equal(code, 0);
    assert.equal((await shell('head -c 4 closed.png | tail -c 3', folder)).stdout, 'PNG');
    const help = await shell('"$TILELIGHTD" --help >/dev/full', folder);
    assert.equal(help.code, 1);
    assert.match(help.stderr, /cannot write standard output: No space left/);
  });
});

describe('a configuration file', () => {
  const refused = async (bytes, pattern) => {
    const path = file('config.json', bytes);
    const { code, stderr } = await tilelightd(['--config', path]);
    assert.equal(code, 2, `${pattern}: ${stderr}`);
    assert.match(stderr, /^tilelightd: .*config\.json/);
    assert.match(stderr, pattern);
    assert.ok(stderr.length < 2000, 'a short word');
  };

  test('that is a directory, a pipe without a writer, endless or absent is refused with the reason', async () => {
    mkdirSync(join(folder, 'conf.d'));
    await shell('mkfifo silent', folder);
    for (const [path, why] of [[join(folder, 'conf.d'), /is a directory/], [join(folder, 'silent'), /is a pipe/],
      ['/dev/zero', /more than 1048576 bytes/], ['/nowhere/x.json', /No such file/], ['', /--config.*FILE missing/]]) {
      const { code, stderr } = await tilelightd([`--config=${path}`]);
      assert.equal(code, 2, stderr);
      assert.match(stderr, why);
    }
    const byEnvironment = await tilelightd([], { env: { TILELIGHT_CONFIG: folder } });
    assert.equal(byEnvironment.code, 2);
    assert.match(byEnvironment.stderr, /is a directory/);
  });

  test('may come through a pipe', async () => {
    const { code, stderr } = await shell('echo \'{"port": 99999}\' | "$TILELIGHTD" --config /dev/stdin', folder);
    assert.equal(code, 2);
    assert.match(stderr, /'port'.*99999/);
  });

  test('that is no flat JSON object is refused with the place', async () => {
    await refused('', /is empty/);
    await refused(' \n\t', /is empty/);
    await refused('[]', /expected one JSON object.*found a list/);
    await refused('"port"', /expected one JSON object.*found a string/);
    await refused('{"port": 80', /:1:\d+: not JSON/);
    await refused('{"port": 80}{}', /:1:13: not JSON/);
    await refused('{"port": 80}\0{"host": "0.0.0.0"}', /:1:13: found a NUL byte/);
    await refused('\x7fELF\0\0', /NUL byte/);
    await refused(Buffer.from([0x7b, 0x22, 0xff, 0x22, 0x3a, 0x31, 0x7d]), /:1:3: not JSON.*UTF-8/);
    await refused('{"port": '.repeat(100_000), /:1:2: 'port' is an object/);
    await refused(`{"port": ${'['.repeat(1_000_000)}`, /'port' is a list/);
    await refused(`{"host": "${'x'.repeat(2 << 20)}"}`, /more than 1048576 bytes/);
  });

  test('that says a thing twice, or one of the wrong type, is refused by name and place', async () => {
    await refused('{"port": 8080,\n "threads": 1,\n "port": 9090}', /:3:2: 'port' comes twice; line 1/);
    await refused('{"max_queue": 1,\n\n  "max-queue": 2}', /:3:3: 'max-queue' comes twice/);
    await refused('{"port": "80"}', /:1:2: 'port' is a string.*allowed: a whole number/);
    await refused('{"port": 80.5}', /'port' is the number 80\.5/);
    await refused('{"port": 1e3}', /'port' is the number 1e3/);
    await refused('{"port": null}', /'port' is null/);
    await refused('{"host": 5}', /'host' is a whole number, 5; allowed: a string/);
    await refused('{"quiet": 1}', /'quiet' is a whole number.*true or false/);
    await refused('{"port": 18446744073709551615}', /'port'.*not a whole number from 0 to 65535/);
    await refused('{"allowed_hosts": ["a"]}', /'allowed_hosts' is a list/);
    await refused('{"prot": 80}', /:1:2: 'prot' is no setting/);
    await refused('{"\u202eport\u009b31m": 80}', /'\\u202eport\\u009b31m' is no setting/);
  });
});

test('a machine that has no threads or memory for the server is an error and no hang', async (t) => {
  const limited = (flags) => shell(`prlimit --as=900000000 "$TILELIGHTD" ${flags}`, folder);
  if ((await limited('--version')).code !== 0) return t.skip('sanitizers take more address space than that');
  const { code, stderr } = await limited('--port 0 --admin-port 0 --threads 1024');
  assert.equal(code, 1, stderr);
  assert.match(stderr, /^tilelightd: cannot start: /);
});

describe('an address to listen on', () => {
  test('is public by what it stands for, not by how it is spelled', async () => {
    for (const host of ['0.0.0.0', '0', '::', '::ffff:0.0.0.0', '::ffff:8.8.8.8', '8.8.8.8', '010.0.0.1']) {
      for (const flag of host === '0' ? ['--host', '--admin-host'] : ['--host']) {
        const { code, stderr } = await tilelightd([`${flag}=${host}`, '--port', '0', '--admin-port', '0']);
        assert.equal(code, 2, `${flag} ${host}`);
        assert.ok(stderr.includes('--allow-open') && stderr.includes(`${flag} ${host}`), stderr);
      }
    }
    for (const host of ['127.no-such-name.invalid', '127.0.0.1.invalid', ' ']) {
      const { code, stderr } = await tilelightd(['--host', host, '--port', '0', '--admin-port', '0']);
      assert.equal(code, 2, host);
      assert.ok(stderr.includes(`no address of '${host}' is known`), stderr);
    }
  });

  test('may be this machine in any spelling', async () => {
    for (const host of ['localhost', '127.1', '2130706433', '0x7f.1', '127.255.255.254', '::ffff:127.0.0.1']) {
      const server = await startServer(['--host', host]);
      assert.equal((await fetch(`${server.url}/v1/limits`)).status, 200, host);
      assert.equal(await server.stop(), 0);
    }
  });
});

describe("others' text", () => {
  const steering = '\u009b31m\u0007\u007f\u202e\u2066\u200e\u061c\u2028\u2029\u200b\u{e0041}\ufeff';

  test('cannot steer the terminal that shows a log', async () => {
    for (const format of ['text', 'json']) {
      const server = await startServer(['--log-format', format]);
      await fetch(`${server.url}/${encodeURIComponent(`a${steering}b`)}`);
      await fetch(`${server.url}/%ff%9b31m%0d%0aforged`);
      const raw = Buffer.from('GET /raw\xc2\x9b31m\xe2\x80\xae\xff HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n', 'latin1');
      await sendBytes(server.port, raw);
      await server.stop();
      const log = server.output();
      assert.match(log, /\/raw\\u009b31m\\u202e/, 'bytes that no browser would send so');
      assert.doesNotMatch(log, /(?!\n)[\p{Cc}\p{Cf}\p{Zl}\p{Zp}\p{Cn}]/u);
      assert.doesNotMatch(log, /^forged/m);
      if (format === 'json') {
        const requests = log.split('\n').filter((it) => it.startsWith('{')).map((it) => JSON.parse(it));
        assert.ok(requests.some((it) => it.path?.startsWith('/a') && decodeURIComponent(it.path) === `/a${steering}b`),
          'and reads back to what was sent');
      }
    }
  });

  test('cannot steer the terminal that shows an answer about a scene', async () => {
    const name = `glass${steering}`;
    const scene = { image: { width: 8, height: 8 }, materials: { [name]: {}, [`unused${steering}`]: {} },
      objects: [{ type: 'sphere', material: name, name: `ball${steering}` }] };
    const server = await startServer();
    const plan = await (await post(server, '/v1/plan', scene)).text();
    await server.stop();
    const path = file('named.json', JSON.stringify(scene));
    const shown = [plan];
    for (const args of [['plan', path], ['plan', path, '--json'], ['render', path, '--pixel', '4,4'],
      ['render', path, '-o', join(folder, 'named.png'), '--report', '-']]) {
      const { code, stdout, stderr } = await tilelight(...args);
      assert.equal(code, 0, stderr);
      shown.push(String(stdout), stderr);
    }
    for (const text of shown) assert.doesNotMatch(text, /(?!\n)[\p{Cc}\p{Cf}\p{Zl}\p{Zp}\p{Cn}]/u);
    const told = JSON.stringify(JSON.parse(plan));
    assert.ok(told.includes(JSON.stringify(`unused${steering}`).slice(1, -1)), 'and reads back to what was sent');
  });

  test('cannot steer the terminal that shows a problem or what the command says', async () => {
    const scene = { objects: [{ type: steering }], [`x${steering}`]: 1 };
    const server = await startServer();
    const answer = await post(server, '/v1/renders', scene);
    assert.equal(answer.status, 422);
    const text = await answer.text();
    assert.doesNotMatch(text, /[\p{Cc}\p{Cf}\p{Zl}\p{Zp}\p{Cn}]/u);
    assert.ok(JSON.parse(text).errors.some((error) => error.pointer === `/x${steering}`));
    await server.stop();
    const path = file(`scene${'\u202e'}.json`, JSON.stringify(scene));
    for (const [shows, ...args] of [[true, 'render', path, '-o', 'x.png'], [true, 'render', `no${steering}`, '-o', 'x.png'],
      [true, `no${steering}`], [true, 'render', '-o', `x.p${steering}`, path], [false, 'chess', steering, '-o', 'x.png']]) {
      const { code, stderr } = await tilelight(...args);
      assert.notEqual(code, 0);
      if (shows) assert.match(stderr, /\\u/);
      assert.doesNotMatch(stderr, /(?!\n)[\p{Cc}\p{Cf}\p{Zl}\p{Zp}\p{Cn}]/u);
    }
    const flag = await tilelightd([`--${steering}`]);
    assert.doesNotMatch(flag.stderr, /(?!\n)[\p{Cc}\p{Cf}\p{Zl}\p{Zp}\p{Cn}]/u);
  });
});
