// SPDX-License-Identifier: Apache-2.0
// The server's HTTP interface, as far as the page uses it. Every failure is one of two: a Problem, which the server
// explained, or Unreachable.

const kJson = { 'Content-Type': 'application/json' };

// Where the server's paths begin, as the browser sees it: a proxy may have put them under one of its own.
export const kBaseUrl = new URL('..', import.meta.url).href.replace(/\/$/, '');

// What the server said was wrong (RFC 9457); `errors` has one entry a mistake in a scene.
export class Problem extends Error {
  constructor(status, body, retryAfterS) {
    super(body.detail || body.title || `The server answered ${status}.`);
    this.status = status;
    this.errors = Array.isArray(body.errors) ? body.errors : [];
    if (this.errors.length === 0 && body.line) this.errors = [{ ...body, pointer: body.pointer ?? '' }];
    this.retryAfterS = retryAfterS;
  }
}

export class Unreachable extends Error {
  constructor() {
    super('The server cannot be reached.');
  }
}

// The outcome of a part of the exchange. The connection can be lost before the answer as well as inside its body.
async function received(part) {
  try {
    return await part;
  } catch (error) {
    if (error.name === 'AbortError') throw error;
    throw new Unreachable();
  }
}

async function call(path, options) {
  const response = await received(fetch(kBaseUrl + path, options));
  if (response.ok) return response;
  const body = await response.json().catch((error) => {
    if (error.name === 'AbortError') throw error;
    return {};
  });
  throw new Problem(response.status, body, Number(response.headers.get('Retry-After')) || 1);
}

const jsonOf = async (answer) => received((await answer).json());
const textOf = async (answer) => received((await answer).text());
const blobOf = async (answer) => received((await answer).blob());

export async function listScenes() {
  return jsonOf(call('/scenes/index.json'));
}

export async function loadScene(file) {
  return textOf(call(`/scenes/${encodeURIComponent(file)}`));
}

// `sceneText` goes as it was written, so that lines and columns of an answer are those of the editor.
export async function openSession(sceneText) {
  return jsonOf(call('/v1/sessions', { method: 'POST', headers: kJson, body: sceneText }));
}

export async function closeSession(id) {
  await call(`/v1/sessions/${id}`, { method: 'DELETE', keepalive: true });
}

export async function putView(id, view) {
  await call(`/v1/sessions/${id}/view`, { method: 'PUT', headers: kJson, body: JSON.stringify(view) });
}

// Waits for a frame newer than number `after`; null when none came in time. `layer`: color, or error for a map of it.
export async function nextFrame(id, after, format, signal, layer = 'color') {
  const path = `/v1/sessions/${id}/frame?after=${after}${layer === 'color' ? '' : `&layer=${layer}`}`;
  const response = await call(path, { headers: { Accept: format }, signal });
  if (response.status === 204) return null;
  return {
    number: Number(response.headers.get('Frame-Seq')),
    viewSeq: Number(response.headers.get('View-Seq')),
    isFinal: response.headers.get('Frame-Final') === '?1',
    ...parseRenderInfo(response.headers.get('Render-Info')),
    timings: parseServerTiming(response.headers.get('Server-Timing')),
    blob: await blobOf(response),
  };
}

// What may be asked for: {samples, time_ms, ...}.
export async function limits() {
  return jsonOf(call('/v1/limits'));
}

// The scene language as the server speaks it: a JSON Schema.
export async function sceneSchema() {
  return jsonOf(call('/v1/schema/scene.json'));
}

// The id under which the server keeps a scene, for a while.
export async function storeScene(sceneText) {
  return (await jsonOf(call('/v1/scenes', { method: 'POST', headers: kJson, body: sceneText }))).id;
}

// What the server would do for a whole scene document, and what that should cost; nothing is drawn.
export async function planOf(document) {
  return jsonOf(call('/v1/plan', { method: 'POST', headers: kJson, body: JSON.stringify(document) }));
}

// A finished picture of a whole scene document. Takes as long as it takes: a render that the server turned into a job
// is waited for.
export async function renderImage(document, format = 'image/png') {
  const headers = { ...kJson, Accept: format };
  const response = await call('/v1/renders', { method: 'POST', headers, body: JSON.stringify(document) });
  if (response.status !== 202) return blobOf(response);
  const job = await jobOf(response);
  await finished(job);
  return imageOf(job, format);
}

// As renderImage(), with the server's report: {blob, report}. An order that is called off by `signal` is taken back.
export async function renderStill(body, { format = 'image/png', signal } = {}) {
  const headers = { ...kJson, Prefer: 'respond-async' };
  // Not called off half way: nobody would know the name of the job, and so could take it back.
  const accepted = await call('/v1/renders', { method: 'POST', headers, body: JSON.stringify(body) });
  const job = await jobOf(accepted);
  try {
    const { report } = await finished(job, signal);
    return { blob: await imageOf(job, format, signal), report };
  } finally {
    call(job, { method: 'DELETE', keepalive: true }).catch(() => {});  // the server forgets it by itself, later
  }
}

// The path of the job that the server answered with. Not its Location, which not every proxy rewrites.
const jobOf = async (accepted) => `/v1/renders/${(await jsonOf(accepted)).id}`;

// The status of a job when it is done.
async function finished(job, signal) {
  for (;;) {
    const status = await jsonOf(call(job, { headers: { Prefer: 'wait=30' }, signal }));
    if (status.state === 'done') return status;
    if (status.state !== 'queued' && status.state !== 'running') {
      throw new Problem(409, { detail: status.error?.detail ?? `The render was ${status.state}.` });
    }
  }
}

function imageOf(job, format, signal) {
  return blobOf(call(`${job}/image`, { headers: { Accept: format }, signal }));
}

// {spp, rmse, stop} of a Render-Info header: samples a pixel, the error of the picture (null while unknown) and the rule
// that ended it (null while none has).
export function parseRenderInfo(header) {
  const find = (pattern) => pattern.exec(header ?? '')?.[1] ?? null;
  const rmse = find(/(?:^|[ ,])rmse=([\d.]+)/);
  return {
    spp: Number(find(/(?:^|[ ,])spp=([\d.]+)/) ?? 0),
    rmse: rmse === null ? null : Number(rmse),
    stop: find(/(?:^|[ ,])stop="(\w+)"/),
  };
}

// {name: milliseconds} of a Server-Timing header.
export function parseServerTiming(header) {
  const timings = {};
  for (const entry of (header ?? '').split(',')) {
    const match = /^\s*([\w-]+)\s*;.*\bdur=([\d.]+)/.exec(entry);
    if (match) timings[match[1]] = Number(match[2]);
  }
  return timings;
}
