// SPDX-License-Identifier: Apache-2.0
// Failures that pass by themselves, and how long to wait before asking again.
import { Problem, Unreachable } from './api.js';

const kBackoffMs = [500, 1000, 2000, 4000, 8000];

// What is in the way: 'offline', 'busy', or null when asking again would not help.
export function hindranceOf(error) {
  if (error instanceof Unreachable) return 'offline';
  const isBusy = error instanceof Problem && (error.status === 429 || error.status === 503);
  return isBusy ? 'busy' : null;
}

// As long as a busy server asked for, or longer with every attempt to reach one; ends early when the browser says that
// the network is back.
export function waitOut(error, attempt) {
  const isBusy = hindranceOf(error) === 'busy';
  return pause(isBusy ? error.retryAfterS * 1000 : kBackoffMs[Math.min(attempt, kBackoffMs.length - 1)]);
}

function pause(ms) {
  return new Promise((resolve) => {
    const end = () => {
      clearTimeout(timer);
      globalThis.removeEventListener?.('online', end);
      resolve();
    };
    const timer = setTimeout(end, ms);
    globalThis.addEventListener?.('online', end);
  });
}
