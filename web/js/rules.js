// SPDX-License-Identifier: Apache-2.0
// When a picture is finished: after so many samples, at such an error, or after some time. A rule is {key, value} with
// the key and the unit that it has in `render` of a scene; null leaves it to the scene. Pure.
import { chosenDuration, errorText, samplesText } from './numbers.js';

const kServerSamples = 16;  // where a scene has no rule at all
const kSettled = ['samples', 'rmse', 'time_ms', 'passes', 'adaptive'];  // what a rule settles in place of the scene
const kSlope = -3 / 4;  // of error against samples where there are edges: renderer/film/README.md

// `factor`: one of the unit that the user reads and writes, in the scene's unit.
export const kRules = {
  samples: { unit: 'samples a pixel', factor: 1, presets: [4, 16, 64, 256], first: 64, isWhole: true, most: 4096 },
  rmse: { unit: 'of the way from black to white', factor: 1, presets: [0.01, 0.004, 0.002, 0.001], first: 0.004, most: 1 },
  time_ms: { unit: 'seconds', factor: 1000, presets: [0.5, 2, 10, 60], first: 2000, most: 600_000 },
};

// The rule that a user's number, or a link's, means: {rule}, or {error} in words. `limits` as the server tells them.
export function readRule(key, text, { factor = kRules[key].factor, limits = {} } = {}) {
  const { isWhole, most: usual } = kRules[key];
  const most = (limits[key] ?? usual) / factor;
  const typed = text.trim();
  const number = typed === '' ? NaN : Number(typed.replace(',', '.'));
  const isGood = isWhole ? Number.isInteger(number) && number >= 1 : number > 0;
  if (isGood && number <= most) return { rule: { key, value: Number((number * factor).toPrecision(12)) } };
  const allowed = isWhole ? `whole numbers from 1 to ${most}` : `numbers above 0, up to ${most}`;
  return { error: `${typed === '' ? 'No number was given' : `Found “${typed}”`}; allowed: ${allowed}.` };
}

// `render` of a scene under the rule.
export function withRule(render = {}, rule) {
  if (!rule) return render;
  const kept = Object.entries(render).filter(([key]) => !kSettled.includes(key));
  return { ...Object.fromEntries(kept), [rule.key]: rule.value };
}

// The same as a change of a session's view, in which null takes away what the scene says.
export function rulePatch(rule) {
  return { ...Object.fromEntries(kSettled.map((key) => [key, null])), [rule.key]: rule.value };
}

// The rules in force, in words: whichever holds first ends the picture.
export function describeRules(render = {}) {
  const samples = samplesAsked(render);
  const words = [
    samples && `${samplesText(samples)} a pixel`,
    render.rmse && `an error of ${errorText(render.rmse)}`,
    render.time_ms && chosenDuration(render.time_ms),
  ].filter(Boolean);
  return words.length > 1 ? `${words.join(' or ')}, whichever comes first` : words[0];
}

// How near a picture is to its end, 0 to 1: by the rule that is nearest.
export function progressOf({ spp, rmse, timings }, render = {}) {
  const samples = samplesAsked(render);
  const shares = [
    samples ? spp / samples : 0,
    render.rmse && rmse ? (render.rmse / rmse) ** (1 / -kSlope) : 0,
    render.time_ms ? (timings.render ?? 0) / render.time_ms : 0,
  ];
  return Math.min(1, Math.max(...shares));
}

// Why a finished picture is finished; `stop` is the server's word for it.
export function endOf({ stop, spp }, render = {}) {
  if (stop === 'rmse' && render.rmse) return `Error ${errorText(render.rmse)} reached`;
  if (stop === 'time' && render.time_ms) return `Time is up: ${chosenDuration(render.time_ms)}`;
  return `${samplesText(spp)} taken`;
}

// Null where only an error or a time ends the picture.
export function samplesAsked(render = {}) {
  const listed = Array.isArray(render.passes) ? render.passes.reduce((sum, pass) => sum + pass, 0) : null;
  return render.samples ?? listed ?? (render.time_ms || render.rmse ? null : kServerSamples);
}

// Samples a pixel for pictures that shall differ in nothing but their method: as many as are asked for, and where an
// error or a time ends the picture, no more than a scene without rules takes.
export function comparableSamples(render = {}) {
  const isOpen = Boolean(render.time_ms || render.rmse);
  const samples = Math.max(1, Math.round(samplesAsked(render) ?? kServerSamples));
  return isOpen ? Math.min(samples, kServerSamples) : samples;
}
