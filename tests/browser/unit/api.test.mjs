// SPDX-License-Identifier: Apache-2.0
// What the page's calls make of answers that break off or refuse; fetch is played by the test.
import assert from 'node:assert/strict';
import { afterEach, test } from 'node:test';
import { loadScene, nextFrame, openSession, Problem, renderImage, Unreachable } from '../../../web/js/api.js';

const kFetch = globalThis.fetch;
afterEach(() => { globalThis.fetch = kFetch; });

function answerWith(body, init) {
  globalThis.fetch = async () => new Response(body, init);
}

// A body of which some bytes come, and then `error`.
function breaksWith(error) {
  let isBegun = false;
  return new ReadableStream({
    pull(controller) {
      if (isBegun) controller.error(error);
      else controller.enqueue(new Uint8Array([123]));
      isBegun = true;
    },
  });
}

const kReaders = {
  frame: () => nextFrame('s1', 0, 'image/png'),
  picture: () => renderImage({}),
  scene: () => loadScene('cubes.json'),
  session: () => openSession('{}'),
};

for (const [what, read] of Object.entries(kReaders)) {
  test(`a connection that is lost inside a ${what} is a server out of reach`, async () => {
    answerWith(breaksWith(new TypeError('network error')));
    await assert.rejects(read(), Unreachable);
  });

  test(`a wait that is called off inside a ${what} stays called off`, async () => {
    answerWith(breaksWith(new DOMException('called off', 'AbortError')));
    await assert.rejects(read(), { name: 'AbortError' });
  });
}

test('a refusal whose reasons are lost on the way is still a refusal', async () => {
  answerWith(breaksWith(new TypeError('network error')), { status: 503, headers: { 'Retry-After': '7' } });
  const isRefusal = (error) => error instanceof Problem && error.status === 503 && error.retryAfterS === 7;
  await assert.rejects(openSession('{}'), isRefusal);
});
