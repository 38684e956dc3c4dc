// SPDX-License-Identifier: Apache-2.0
// The way from hand to picture: gestures push the camera, the camera becomes views of a session, the session's frames
// are drawn. While moving, a smaller picture is asked for; at rest, the full one, which then refines.
import { fitToAspect, toSceneCamera } from './camera.js';
import { watchPixelRatio } from './dom.js';
import { attachGestures } from './gestures.js';
import { Inertia, kSettleMs } from './inertia.js';
import { Picture } from './picture.js';
import { isAbout, moved, rangeOf } from './range.js';
import { fullSize, nextScale, scaledSize } from './resolution.js';
import { rulePatch } from './rules.js';
import { kOverdueMs, ViewSession } from './session.js';

const kRestMs = 140;      // without movement before the full picture is asked for
const kResizeMs = 120;
const kFirstScale = 0.25;
const kMaxStepMs = 50;    // a tab that slept does not jump

export class Viewer {
  #canvas;
  #picture;
  #session;
  #inertia;
  #on;
  #camera = null;
  #home = null;   // the scene's own camera; #camera is this very object until it is moved
  #range = null;  // how far #camera may go, as of range.js
  #rule = null;
  #method = {};
  #pictureAspect = 16 / 9;
  #full = { width: 1, height: 1 };
  #scale = kFirstScale;
  #cursor = { x: 0, y: 0 };
  #ticking = false;
  #lastTick = 0;
  #restTimer = 0;
  #resizeTimer = 0;

  // `on.frame({frame, size, moving})` after a picture was drawn, `on.state(name, problem)` as of ViewSession,
  // `on.moved()` when the camera left its place.
  constructor(canvas, { api, on }) {
    this.#canvas = canvas;
    this.#on = on;
    this.#picture = new Picture(canvas);
    const calm = matchMedia('(prefers-reduced-motion: reduce)').matches;
    this.#inertia = new Inertia(calm ? 0 : kSettleMs);
    this.#session = new ViewSession({
      api,
      on: { frame: (event) => this.#drawn(event), overdue: () => this.#slowDown(), state: on.state },
    });
    attachGestures(canvas, { move: (part, cursor) => this.#move(part, cursor), reset: () => this.reset() });
    this.#measure();
    new ResizeObserver(() => this.#measureSoon()).observe(canvas);
    watchPixelRatio(() => this.#measureSoon());
    addEventListener('pagehide', () => this.#session.close());
  }

  // Shows the scene whose text `load()` gives. `camera` = where to look from, instead of the scene's own camera;
  // `keepsView` = from where the hand went, if it did and the scene is still about there. `adaptMethod(wish)` = what is
  // left of the wish for a method once the scene is there.
  open(load, { camera, keepsView, adaptMethod }) {
    return this.#session.open(load, (info) => {
      this.#inertia.stop();
      this.#method = adaptMethod(this.#method);
      this.#range = rangeOf(info.bounds, info.camera);
      const isKept = keepsView && this.#camera !== this.#home && isAbout(this.#camera, this.#range);
      this.#camera = camera ?? (isKept ? this.#camera : info.camera);
      this.#home = info.camera;
      this.#pictureAspect = info.image.width / info.image.height;
      this.#restSoon();
      return this.#view(true);  // a small picture at once is better than a large one later
    });
  }

  // What ends the pictures that are asked for from now on, as of rules.js; null = what the scene says.
  setRule(rule) {
    this.#rule = rule;
  }

  // What draws the pictures that are asked for from now on.
  setMethod(method) {
    this.#method = method;
  }

  // Asks for the present view from the first sample on.
  drawAgain() {
    if (this.#camera) this.#session.look(this.#view(false));
  }

  errorMap(frame) {
    return this.#session.errorMap(frame);
  }

  get camera() {
    return this.#camera;
  }

  // What a full render of the present view takes: the keys `camera` and `image` of a scene, the rule and the method.
  get still() {
    return { camera: this.#fitted(), image: { ...this.#full }, rule: this.#rule, method: this.#method };
  }

  reset() {
    if (!this.#home) return;
    this.#inertia.stop();
    this.#camera = this.#home;
    this.#session.look(this.#view(true));
    this.#restSoon();
  }

  #fitted() {
    return toSceneCamera(fitToAspect(this.#camera, this.#pictureAspect, this.#full.width / this.#full.height));
  }

  #view(moving) {
    const image = moving ? scaledSize(this.#full, this.#scale) : this.#full;
    const render = { ...(this.#rule && !moving ? rulePatch(this.#rule) : {}), ...this.#method };
    return { camera: this.#fitted(), image, moving, ...(Object.keys(render).length > 0 ? { render } : {}) };
  }

  #move(part, cursor) {
    if (!this.#camera) return;
    if (cursor) this.#cursor = cursor;
    else if ('zoomLog' in part) this.#cursor = { x: 0, y: 0 };
    this.#inertia.push(part);
    this.#on.moved();
    if (this.#ticking) return;
    this.#ticking = true;
    this.#lastTick = performance.now();
    requestAnimationFrame((time) => this.#tick(time));
  }

  #tick(time) {
    const elapsedMs = Math.min(kMaxStepMs, Math.max(1, time - this.#lastTick));
    this.#lastTick = time;
    const part = this.#inertia.take(elapsedMs);
    this.#camera = moved(this.#camera, part, this.#cursor, this.#range);
    this.#session.look(this.#view(true));
    this.#restSoon();
    this.#ticking = this.#inertia.isMoving;
    if (this.#ticking) requestAnimationFrame((next) => this.#tick(next));
  }

  #restSoon() {
    clearTimeout(this.#restTimer);
    this.#restTimer = setTimeout(() => this.#session.look(this.#view(false)), kRestMs);
  }

  async #drawn({ frame, moving, latencyMs }) {
    if (moving && latencyMs !== null) this.#scale = nextScale(this.#scale, latencyMs, frame.timings.render);
    const size = await this.#picture.show(frame);
    if (size) this.#on.frame({ frame, size, moving });
  }

  #slowDown() {
    this.#scale = nextScale(this.#scale, kOverdueMs);
  }

  #measureSoon() {
    clearTimeout(this.#resizeTimer);
    this.#resizeTimer = setTimeout(() => this.#resized(), kResizeMs);
  }

  #measure() {
    this.#full = fullSize(this.#canvas.clientWidth, this.#canvas.clientHeight, devicePixelRatio || 1);
    this.#picture.resize(this.#full);
  }

  #resized() {
    const before = this.#full;
    this.#measure();
    if (!this.#camera || (before.width === this.#full.width && before.height === this.#full.height)) return;
    this.#session.look(this.#view(false));
  }
}
