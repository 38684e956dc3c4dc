// SPDX-License-Identifier: Apache-2.0
// The curve of error against time of the view on show, a point a pass, and the last finished one before it. Pure.

export class Curves {
  current = { viewSeq: 0, points: [], isFinal: false };
  newest = null;  // {spp, rmse, ms} of the newest frame; rmse null while unknown, 0 where it has no place on the curve
  before = null;

  // Takes a frame: {viewSeq, spp, rmse, timings, isFinal}. Of one sample no error is known, and it makes no point.
  take({ viewSeq, spp, rmse, timings, isFinal }) {
    if (viewSeq < this.current.viewSeq) return;
    if (viewSeq > this.current.viewSeq) {
      if (this.current.isFinal && this.current.points.length > 0) this.before = this.current;
      this.current = { viewSeq, points: [], isFinal: false };
    }
    const { points } = this.current;
    const isTold = points.length > 0 && spp <= points.at(-1).spp;  // the last pass may come twice, final the second time
    this.newest = { spp, rmse, ms: timings.render };
    if (rmse > 0 && timings.render > 0 && !isTold) points.push(this.newest);
    this.current.isFinal ||= isFinal;
  }
}

// The curve for those who do not see it.
export function describeCurve(points) {
  if (points.length === 0) return 'Error against render time: nothing is known yet.';
  const say = ({ rmse, ms }) => `${rmse.toPrecision(2)} after ${(ms / 1000).toPrecision(2)} s`;
  const last = say(points.at(-1));
  if (points.length === 1) return `Error against render time, so far one pass: ${last}.`;
  return `Error against render time, both on logarithmic scales: from ${say(points[0])} to ${last}, in ${points.length} passes.`;
}
