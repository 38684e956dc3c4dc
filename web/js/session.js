// SPDX-License-Identifier: Apache-2.0
// An interactive session with the server: views go out, frames come back, and the newest view wins. A moving view is
// seen before the next one goes, so views never queue up; a still one gives way at once. A session that expired, a server
// that is busy or cannot be reached are lived through; the last wish is kept and sent again.
import { Problem } from './api.js';
import { hindranceOf, waitOut } from './patience.js';

export const kOverdueMs = 600;  // a moving view not seen by then is given up for a newer one

// A later open() came before this one was answered.
export class Superseded extends Error {}

const isGone = (error) => error instanceof Problem && (error.status === 404 || error.status === 410);
const isRefusal = (error) => !isGone(error) && !hindranceOf(error);

export class ViewSession {
  #api;
  #on;
  #now;
  #text = null;
  #id = null;
  #opens = 0;
  #wanted = { seq: 0 };  // the newest view; its seq grows over all sessions, so an old frame is known by it
  #sent = { seq: 0 };    // the view that the server has: {seq, moving, atMs}
  #seenSeq = 0;          // the newest view of which a frame came, or a refusal
  #refusedSeq = null;    // the view that the server refused last, until a newer one is seen; null if there is none
  #isFinal = false;      // and that frame was its last
  #frameNumber = 0;
  #polling = null;       // AbortController of the wait for frames
  #overdueTimer = 0;
  #recovery = null;      // token of the attempt to go on after a failure

  // `on.frame({frame, moving, latencyMs})` gets every frame of a view that was asked for, moving also where a newer view
  // is on its way, latencyMs with the first frame of the newest; `on.overdue()` says that a moving view was given up;
  // `on.state(name, problem)` is one of live, busy, offline, failed. `now` is in milliseconds.
  constructor({ api, on, now = () => performance.now() }) {
    this.#api = api;
    this.#on = on;
    this.#now = now;
  }

  // Opens the scene whose text `load()` gives, in place of the present one, which lives on if the server refuses. A
  // server that is busy or out of reach is asked until it answers or another scene is wanted. Returns the server's
  // account of it and the text. `firstView(info)` gives the view to start with.
  async open(load, firstView) {
    const turn = ++this.#opens;
    const { text, info } = await this.#insist(turn, load);
    if (turn !== this.#opens) {
      this.#discard(info.id);
      throw new Superseded();
    }
    if (this.#id) this.#discard(this.#id);
    this.#text = text;
    this.#adopt(info.id);
    this.look(firstView(info));
    return { ...info, text };
  }

  async #insist(turn, load) {
    for (let attempt = 0; ; ++attempt) {
      try {
        const text = await load();
        return { text, info: await this.#api.openSession(text) };
      } catch (error) {
        if (turn !== this.#opens) throw new Superseded();
        const hindrance = hindranceOf(error);
        if (!hindrance) {
          if (!this.#recovery) this.#on.state('live');  // it was reached, after all
          this.#refusedSeq = this.#wanted.seq;          // what is said of it lasts until the next view is seen
          throw error;
        }
        this.#on.state(hindrance);
        await waitOut(error, attempt);
        if (turn !== this.#opens) throw new Superseded();
      }
    }
  }

  look(view) {
    this.#wanted = { ...view, seq: this.#wanted.seq + 1 };
    this.#send();
  }

  // The error by pixel of `frame`, or of a newer one; null if it cannot be had, of which the state tells.
  async errorMap(frame) {
    const id = this.#id;
    try {
      return await this.#api.nextFrame(id, frame.number - 1, 'image/png', undefined, 'error');
    } catch (error) {
      this.#fail(id, error);
      return null;
    }
  }

  close() {
    this.#polling?.abort();
    if (this.#id) this.#discard(this.#id);
    this.#id = null;
  }

  #adopt(id) {
    this.#polling?.abort();
    this.#polling = null;
    this.#recovery = null;
    this.#refusedSeq = null;
    this.#id = id;
    this.#sent = { seq: 0 };
    this.#frameNumber = 0;
    this.#on.state('live');
  }

  #discard(id) {
    this.#api.closeSession(id).catch(() => {});  // it expires by itself
    return null;
  }

  #send() {
    if (!this.#id || this.#recovery || this.#sent.seq === this.#wanted.seq) return;
    if (this.#sent.moving && this.#seenSeq < this.#sent.seq) {
      const leftMs = this.#sent.atMs + kOverdueMs - this.#now();
      if (leftMs > 0) {
        clearTimeout(this.#overdueTimer);
        this.#overdueTimer = setTimeout(() => this.#send(), leftMs);
        return;
      }
      this.#on.overdue();
    }
    const id = this.#id;
    this.#sent = { seq: this.#wanted.seq, moving: this.#wanted.moving, atMs: this.#now() };
    this.#isFinal = false;
    const { seq } = this.#wanted;
    this.#api.putView(id, this.#wanted).catch((error) => this.#fail(id, error, seq));
    if (!this.#polling) this.#poll(id);
  }

  // Takes frames until the newest view has its last one.
  async #poll(id) {
    const polling = new AbortController();
    this.#polling = polling;
    while (!polling.signal.aborted && !this.#isFinal) {
      const { seq } = this.#sent;
      try {
        const format = this.#wanted.moving ? 'image/jpeg' : 'image/png';
        const frame = await this.#api.nextFrame(id, this.#frameNumber, format, polling.signal);
        if (frame && !polling.signal.aborted) this.#take(frame);
      } catch (error) {
        if (error.name === 'AbortError') break;
        if (isRefusal(error) && seq < this.#sent.seq) continue;  // of a view that a newer one has replaced since
        this.#fail(id, error, seq);
        break;
      }
    }
    if (this.#polling === polling) this.#polling = null;
  }

  #take(frame) {
    this.#frameNumber = frame.number;
    if (frame.viewSeq > 0) {  // 0 is the scene's own view, in its own size
      const isNewest = frame.viewSeq === this.#sent.seq;
      const latencyMs = isNewest && this.#seenSeq < frame.viewSeq ? this.#now() - this.#sent.atMs : null;
      this.#seenSeq = Math.max(this.#seenSeq, frame.viewSeq);
      this.#isFinal = frame.isFinal && frame.viewSeq === this.#wanted.seq;
      if (this.#refusedSeq !== null && frame.viewSeq > this.#refusedSeq) {
        this.#refusedSeq = null;
        this.#on.state('live');
      }
      this.#on.frame({ frame, moving: !isNewest || this.#sent.moving, latencyMs });
    }
    this.#send();
  }

  // `seq`: the view that it befell.
  async #fail(id, error, seq = this.#sent.seq) {
    if (this.#recovery || id !== this.#id || (isRefusal(error) && seq < this.#sent.seq)) return;
    const recovery = {};
    this.#recovery = recovery;
    this.#polling?.abort();
    this.#polling = null;
    let cause = error;
    for (let attempt = 0; cause && this.#recovery === recovery; ++attempt) cause = await this.#retry(id, cause, attempt);
    if (this.#recovery === recovery) this.#recovery = null;
    this.#send();
  }

  // One attempt to go on after `cause`; returns what stopped it, or null when there is nothing more to try.
  async #retry(id, cause, attempt) {
    const hindrance = hindranceOf(cause);
    if (isRefusal(cause)) {
      this.#refusedSeq = this.#sent.seq;
      this.#seenSeq = this.#sent.seq;  // nothing more will come of it
      this.#on.state('failed', cause);
      return null;
    }
    if (hindrance) {
      this.#on.state(hindrance);
      await waitOut(cause, attempt);
    }
    try {
      if (isGone(cause)) {
        const info = await this.#api.openSession(this.#text);
        if (this.#id !== id) return this.#discard(info.id);
        this.#adopt(info.id);
      } else {
        await this.#api.putView(id, this.#wanted);
        if (this.#id !== id) return null;
        this.#on.state('live');
      }
      this.#wanted = { ...this.#wanted, seq: this.#wanted.seq + 1 };  // what came of the old one may be lost
      return null;
    } catch (error) {
      return error;
    }
  }
}
