// SPDX-License-Identifier: Apache-2.0
// What ends a picture: what users may ask for, and what is sent and said of it.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { comparableSamples, describeRules, endOf, kRules, progressOf, readRule, rulePatch, withRule } from '../../../web/js/rules.js';

test('a number becomes a rule in the unit of the scene language', () => {
  assert.deepEqual(readRule('samples', ' 64 ').rule, { key: 'samples', value: 64 });
  assert.deepEqual(readRule('rmse', '0.004').rule, { key: 'rmse', value: 0.004 });
  assert.deepEqual(readRule('rmse', '0,004').rule, { key: 'rmse', value: 0.004 }, 'as half of Europe writes it');
  assert.deepEqual(readRule('time_ms', '0.5').rule, { key: 'time_ms', value: 500 });
  assert.deepEqual(readRule('time_ms', '500', { factor: 1 }).rule, { key: 'time_ms', value: 500 });
});

test('what is no rule is refused with what was found and what is allowed', () => {
  for (const [key, text] of [['samples', '0'], ['samples', '1.5'], ['samples', '-4'], ['samples', '5000'], ['rmse', '0'],
    ['rmse', '2'], ['rmse', 'small'], ['time_ms', '601'], ['time_ms', 'Infinity'], ['rmse', 'NaN']]) {
    const { rule, error } = readRule(key, text);
    assert.equal(rule, undefined, `${key} ${text}`);
    assert.ok(error.includes(`Found “${text}”; allowed: `), error);
  }
  assert.match(readRule('samples', ' ').error, /^No number was given; allowed: whole numbers from 1 to 4096\.$/);
});

test('the limits are the server\'s', () => {
  assert.equal(readRule('samples', '5000', { limits: { samples: 8192 } }).rule.value, 5000);
  assert.match(readRule('time_ms', '31', { limits: { time_ms: 30_000 } }).error, /up to 30\./);
});

test('every number on offer is a rule', () => {
  for (const [key, { presets, first, factor }] of Object.entries(kRules)) {
    for (const preset of presets) assert.ok(readRule(key, String(preset)).rule, `${key} ${preset}`);
    assert.ok(presets.includes(first / factor));
  }
});

// RFC 7396: null takes a member away.
function merged(render, patch) {
  return Object.fromEntries(Object.entries({ ...render, ...patch }).filter(([, value]) => value !== null));
}

test('a view under a rule is the scene under that rule', () => {
  const scenes = [{}, { samples: 16, max_depth: 3 }, { rmse: 0.1, time_ms: 50, adaptive: false }, { passes: [1, 2], seed: 7 }];
  for (const render of scenes) {
    for (const rule of [{ key: 'samples', value: 4 }, { key: 'rmse', value: 0.01 }, { key: 'time_ms', value: 90 }]) {
      assert.deepEqual(merged(render, rulePatch(rule)), withRule(render, rule));
    }
    assert.equal(withRule(render, null), render);
  }
});

test('rules are told in words', () => {
  assert.equal(describeRules(undefined), '16 samples a pixel');
  assert.equal(describeRules({ passes: [1, 1, 2] }), '4 samples a pixel');
  assert.equal(describeRules({ rmse: 0.004, time_ms: 500 }), 'an error of 0.004 or 0.5 s, whichever comes first');
});

test('a picture is as far as its nearest rule', () => {
  const at = (spp, rmse, ms) => ({ spp, rmse, timings: { render: ms } });
  assert.equal(progressOf(at(4, 0.02, 100), { samples: 16 }), 0.25);
  assert.equal(progressOf(at(4, 0.02, 100), { time_ms: 400 }), 0.25);
  assert.ok(Math.abs(progressOf(at(4, 0.08, 100), { rmse: 0.01 }) - 1 / 16) < 1e-12, 'an eighth at slope -3/4 takes 16 times');
  assert.equal(progressOf(at(8, 0.08, 100), { rmse: 0.01, samples: 16 }), 0.5);
  assert.equal(progressOf(at(1, null, 100), { rmse: 0.01 }), 0);
});

test('a finished picture says why it is finished', () => {
  assert.equal(endOf({ stop: 'samples', spp: 16 }, {}), '16 samples taken');
  assert.equal(endOf({ stop: 'rmse', spp: 12.6 }, { rmse: 0.004 }), 'Error 0.004 reached');
  assert.equal(endOf({ stop: 'time', spp: 12.6 }, { time_ms: 2000 }), 'Time is up: 2 s');
  assert.equal(endOf({ stop: 'samples', spp: 1 }, { rmse: 1e-9 }), '1 sample taken');
});

test('pictures to be compared have as many samples as are asked for, and few where an error or a time would end them', () => {
  assert.equal(comparableSamples({}), 16);
  assert.equal(comparableSamples({ samples: 64 }), 64);
  assert.equal(comparableSamples({ passes: [1, 1, 2] }), 4);
  assert.equal(comparableSamples({ rmse: 0.001 }), 16);
  assert.equal(comparableSamples({ time_ms: 60_000, samples: 4096 }), 16);
  assert.equal(comparableSamples({ time_ms: 60_000, samples: 2 }), 2);
});
