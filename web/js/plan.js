// SPDX-License-Identifier: Apache-2.0
// The plan panel: what the scene uses, what was left out and why, and its size in the server.
import { el } from './dom.js';
import { countText, duration, errorText } from './numbers.js';

const kTimingNames = { parse: 'Reading', queue: 'Waiting', compile: 'Compiling', render: 'Rendering', encode: 'Encoding' };

export function showPlan(container, info) {
  const plan = info.plan ?? {};
  container.replaceChildren(
    block('In use', chips(plan.features ?? [])),
    block('Left out', leftOut(plan.left_out ?? [])),
    ...(info.warnings?.length ? [block('Worth a look', warnings(info.warnings))] : []),
    block('In numbers', facts(plan)),
    el('section', { class: 'this-picture', hidden: true }, el('h3', {}, 'This picture'),
      el('dl', { class: 'facts predicted' }), el('dl', { class: 'facts spent' })),
  );
}

// What the server spent on the picture on show: `timings` in milliseconds by name.
export function showTimings(container, timings) {
  const place = container.querySelector('.this-picture');
  const times = Object.entries(timings);
  if (!place || times.length === 0) return;
  place.hidden = false;
  const spent = times.map(([name, ms]) => [kTimingNames[name] ?? words(name), duration(ms)]);
  place.querySelector('.spent').replaceChildren(...rows(spent));
}

// What it should take with the machine to itself, and how good it will be: {elapsed_ms, mrays, rmse or null}.
export function showPrediction(container, { elapsed_ms: ms, mrays, rmse }) {
  const rays = mrays < 1 ? 'under a million rays' : `${countText(Math.round(mrays))} million rays`;
  const error = Number.isFinite(rmse) ? `, error ${errorText(rmse)}` : '';
  container.querySelector('.predicted').replaceChildren(...rows([['Predicted', `${duration(ms)}, ${rays}${error}`]]));
}

function block(title, ...content) {
  return el('section', {}, el('h3', {}, title), ...content);
}

function words(name) {
  return String(name).replaceAll('_', ' ');
}

function chips(names) {
  if (names.length === 0) return el('p', { class: 'muted' }, 'Nothing beyond the plain ray.');
  return el('ul', { class: 'chips' }, ...names.map((name) => el('li', {}, words(name))));
}

function leftOut(entries) {
  if (entries.length === 0) return el('p', { class: 'muted' }, 'Nothing: this scene uses all there is.');
  return el('dl', { class: 'left-out' },
    ...entries.flatMap(({ what, why, cost }) => [el('dt', {}, words(what).replace(/^feature /, '')),
      el('dd', {}, cost ? `${why}; it would cost ${cost}` : why)]));
}

function warnings(entries) {
  return el('ul', { class: 'warnings' },
    ...entries.map(({ pointer, detail }) => el('li', {}, el('code', {}, pointer || '/'), ' ', detail)));
}

function facts(plan) {
  return el('dl', { class: 'facts' }, ...rows([
    ['Bodies', count(plan.bodies)],
    ['Lights', count(plan.lights)],
    ['Triangles', triangles(plan.triangles)],
    ['Memory', bytes(plan.memory_bytes)],
    ['Kernel', plan.kernel],
    ['Instruction set', plan.isa],
    ['Compiling', duration(plan.compile_ms)],
    ['Planning', duration(plan.plan_ms)],
  ].filter(([, value]) => value)));
}

function rows(entries) {
  return entries.flatMap(([name, value]) => [el('dt', {}, name), el('dd', {}, String(value))]);
}

function count(n) {
  return n === undefined ? null : countText(n);
}

function triangles(of) {
  if (!of) return null;
  if (!of.instanced || of.instanced === of.stored) return countText(of.stored);
  return `${countText(of.instanced)} drawn, ${countText(of.stored)} stored`;
}

function bytes(n) {
  if (n === undefined) return null;
  if (n < 1024 * 1024) return `${Math.max(1, Math.round(n / 1024))} KiB`;
  return `${(n / 1024 / 1024).toFixed(1)} MiB`;
}
