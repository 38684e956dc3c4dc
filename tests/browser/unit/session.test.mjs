// SPDX-License-Identifier: Apache-2.0
// The session against a server played by the test: which views go out, when, and what is done about failures.
import assert from 'node:assert/strict';
import { setImmediate as turn } from 'node:timers/promises';
import { test } from 'node:test';
import { Problem, Unreachable } from '../../../web/js/api.js';
import { kOverdueMs, Superseded, ViewSession } from '../../../web/js/session.js';

// A server that remembers what it was sent and answers frames when told to.
function playServer() {
  const server = { opened: 0, closed: [], views: [], states: [], frames: [], overdue: 0, failPut: null, nowMs: 0 };
  let waiting = [];
  let number = 0;
  server.api = {
    openSession: async () => ({ id: `s${++server.opened}` }),
    closeSession: async (id) => server.closed.push(id),
    putView: async (id, view) => {
      const error = server.failPut;
      server.failPut = null;
      if (error) throw error;
      server.views.push({ id, ...view });
    },
    nextFrame: (id, after, format, signal) => new Promise((resolve, reject) => {
      waiting.push({ resolve, reject });
      signal.addEventListener('abort', () => reject(Object.assign(new Error(), { name: 'AbortError' })));
    }),
  };
  server.answer = async (viewSeq, isFinal = true) => {
    const answered = waiting;
    waiting = [];
    answered.forEach(({ resolve }) => resolve({ number: ++number, viewSeq, isFinal, timings: {} }));
    await turn();
  };
  server.refuseFrame = async (error) => {
    const answered = waiting;
    waiting = [];
    answered.forEach(({ reject }) => reject(error));
    await turn();
  };
  server.session = new ViewSession({
    api: server.api,
    now: () => server.nowMs,
    on: {
      frame: (event) => server.frames.push(event),
      overdue: () => ++server.overdue,
      state: (name) => server.states.push(name),
    },
  });
  return server;
}

// From here on setTimeout waits for tick(ms). By hand, as Node.js 18 has no mock timers that one could use.
function stopTimers(t) {
  const timers = new Map();
  let nowMs = 0;
  let last = 0;
  t.mock.method(globalThis, 'setTimeout', (run, ms) => {
    timers.set(++last, { run, atMs: nowMs + ms });
    return last;
  });
  t.mock.method(globalThis, 'clearTimeout', (timer) => timers.delete(timer));
  return (ms) => {
    nowMs += ms;
    for (const [timer, { run, atMs }] of timers) {
      if (atMs <= nowMs && timers.delete(timer)) run();
    }
  };
}

const kScene = async () => '{}';
const moving = (x) => ({ camera: { x }, moving: true });
const still = (x) => ({ camera: { x }, moving: false });
const sentX = (server) => server.views.map(({ camera }) => camera.x);

test('of many views while one is being drawn, only the newest goes out', async () => {
  const server = playServer();
  await server.session.open(kScene, () => moving(0));
  for (let x = 1; x <= 9; ++x) server.session.look(moving(x));
  await turn();
  assert.deepEqual(sentX(server), [0]);
  await server.answer(server.views[0].seq);
  assert.deepEqual(sentX(server), [0, 9]);
});

test('a view that moves interrupts one that refines, at once', async () => {
  const server = playServer();
  await server.session.open(kScene, () => still(0));
  server.session.look(moving(1));
  await turn();
  assert.deepEqual(sentX(server), [0, 1]);
});

test('the last small picture is seen before the full one is asked for', async () => {
  const server = playServer();
  await server.session.open(kScene, () => moving(0));
  server.session.look(still(1));
  await turn();
  assert.deepEqual(sentX(server), [0]);
  await server.answer(server.views[0].seq);
  assert.deepEqual(sentX(server), [0, 1]);
});

// A server whose moving view 1 did not come in time, and of which view 2 was wanted meanwhile.
async function playOverdue(t) {
  const tick = stopTimers(t);
  const server = playServer();
  await server.session.open(kScene, () => moving(0));
  server.session.look(still(1));
  server.nowMs = kOverdueMs;
  tick(kOverdueMs);
  await turn();
  return server;
}

test('a moving view that never comes is given up for a newer one', async (t) => {
  const server = await playOverdue(t);
  assert.deepEqual(sentX(server), [0, 1]);
  assert.equal(server.overdue, 1);
});

test('a late frame of an older view is no end of the newer one that is on its way', async (t) => {
  const server = await playOverdue(t);
  await server.answer(1, true);
  await server.answer(2, true);
  assert.deepEqual(server.frames.map((event) => event.moving), [true, false]);
});

test('latency is told with the first frame of a view and not with its refinements', async () => {
  const server = playServer();
  await server.session.open(kScene, () => still(0));
  server.nowMs = 70;
  await server.answer(1, false);
  server.nowMs = 90;
  await server.answer(1, true);
  assert.deepEqual(server.frames.map(({ latencyMs }) => latencyMs), [70, null]);
});

test('a session that is gone is opened anew and shown the newest view', async () => {
  const server = playServer();
  await server.session.open(kScene, () => still(0));
  server.failPut = new Problem(404, {});
  server.session.look(still(5));
  await turn();
  await turn();
  assert.equal(server.opened, 2);
  assert.equal(server.views.at(-1).id, 's2');
  assert.equal(server.views.at(-1).camera.x, 5);
  assert.ok(server.views.at(-1).seq > server.views[0].seq, 'a frame of before cannot be taken for a new one');
});

test('a server out of reach is asked again, and the last wish is kept', async (t) => {
  const server = playServer();
  await server.session.open(kScene, () => still(0));
  const tick = stopTimers(t);
  server.failPut = new Unreachable();
  server.session.look(still(5));
  await turn();
  assert.equal(server.states.at(-1), 'offline');
  tick(500);
  await turn();
  assert.equal(server.states.at(-1), 'live');
  assert.equal(server.views.at(-1).camera.x, 5);
  assert.equal(server.opened, 1);
});

test('of two scenes opened at once the later stays and the earlier is closed', async () => {
  const server = playServer();
  const first = server.session.open(kScene, () => still(0));
  const second = server.session.open(kScene, () => still(1));
  await assert.rejects(first, Superseded);
  await second;
  assert.deepEqual(server.closed, ['s1']);
  assert.deepEqual(sentX(server), [1]);
});

test('a scene that the server refuses leaves the one on show alone', async () => {
  const server = playServer();
  await server.session.open(kScene, () => still(0));
  server.api.openSession = async () => { throw new Problem(422, { detail: 'no' }); };
  await assert.rejects(server.session.open(kScene, () => still(1)), Problem);
  server.session.look(still(2));
  await turn();
  assert.deepEqual(server.closed, []);
  assert.equal(server.views.at(-1).id, 's1');
});

const kRefusal = () => new Problem(422, { detail: 'found no number' });

test('what was said of a refused view is taken back when a later one is seen, and not before', async () => {
  const server = playServer();
  await server.session.open(kScene, () => still(0));
  await server.answer(1);
  server.failPut = kRefusal();
  server.session.look(still(NaN));
  await turn();
  assert.equal(server.states.at(-1), 'failed');
  server.session.look(still(2));
  await turn();
  assert.equal(server.states.at(-1), 'failed', 'there is no picture yet');
  await server.answer(2);
  assert.equal(server.states.at(-1), 'failed', 'an older picture says nothing of the new view');
  await server.answer(3);
  assert.equal(server.states.at(-1), 'live');
  assert.deepEqual(sentX(server), [0, 2]);
});

test('a refused view that moved is not waited for, and no sign of a slow server', async () => {
  const server = playServer();
  await server.session.open(kScene, () => still(0));
  server.failPut = kRefusal();
  server.session.look(moving(1));
  await turn();
  server.session.look(still(2));
  await turn();
  assert.deepEqual(sentX(server), [0, 2]);
  assert.equal(server.overdue, 0);
});

test('a refusal that comes after a newer view went out is of no account', async () => {
  const server = playServer();
  await server.session.open(kScene, () => still(0));
  let refuse;
  const { putView } = server.api;
  server.api.putView = () => new Promise((_, reject) => { refuse = reject; });
  server.session.look(still(NaN));
  server.api.putView = putView;
  server.session.look(still(2));
  refuse(kRefusal());
  await turn();
  assert.ok(!server.states.includes('failed'));
  await server.answer(3);
  assert.equal(server.frames.at(-1).frame.viewSeq, 3, 'its frames are still waited for');
});

test('a frame that is refused after a newer view went out is of no account, and one of the newest view is', async () => {
  const server = playServer();
  await server.session.open(kScene, () => still(0));
  server.session.look(still(2));
  await turn();
  await server.refuseFrame(new Problem(500, { detail: 'the render of this view failed' }));
  assert.ok(!server.states.includes('failed'));
  await server.answer(2, false);
  assert.equal(server.frames.at(-1).frame.viewSeq, 2, 'its frames are still waited for');
  await server.refuseFrame(new Problem(500, { detail: 'the render of this view failed' }));
  assert.equal(server.states.at(-1), 'failed');
});

test('what was said of a refused scene is taken back when the one before is moved and seen', async () => {
  const server = playServer();
  await server.session.open(kScene, () => still(0));
  await server.answer(1);
  const { openSession } = server.api;
  server.api.openSession = async () => { throw kRefusal(); };
  await assert.rejects(server.session.open(kScene, () => still(1)), Problem);
  server.api.openSession = openSession;
  const told = server.states.length;
  server.session.look(still(2));
  await turn();
  assert.equal(server.states.length, told);
  await server.answer(2);
  assert.deepEqual(server.states.slice(told), ['live']);
});

test('a scene that is wanted while the server is away or busy is asked for until it comes', async (t) => {
  const tick = stopTimers(t);
  const server = playServer();
  const { openSession } = server.api;
  const answers = [new Unreachable(), new Problem(503, {}, 2)];
  server.api.openSession = async (text) => {
    if (answers.length) throw answers.shift();
    return openSession(text);
  };
  const opening = server.session.open(kScene, () => still(0));
  await turn();
  assert.deepEqual(server.states, ['offline']);
  tick(500);
  await turn();
  assert.deepEqual(server.states, ['offline', 'busy']);
  tick(2000);
  assert.equal((await opening).text, '{}');
  assert.equal(server.states.at(-1), 'live');
  assert.deepEqual(sentX(server), [0]);
});

test('a scene that waits for the server gives way to one that is wanted later', async (t) => {
  const tick = stopTimers(t);
  const server = playServer();
  const { openSession } = server.api;
  server.api.openSession = async () => { throw new Unreachable(); };
  const first = server.session.open(kScene, () => still(0));
  await turn();
  server.api.openSession = openSession;
  await server.session.open(kScene, () => still(1));
  tick(500);
  await assert.rejects(first, Superseded);
  assert.equal(server.opened, 1);
  assert.deepEqual(sentX(server), [1]);
});
