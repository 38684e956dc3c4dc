// SPDX-License-Identifier: Apache-2.0
// The curve as SVG, in CSS pixels, so that its letters are as large as those around it. Colours are the style sheet's.
import { describeCurve } from './curves.js';
import { logAxis, slopeLine } from './log_axis.js';
import { duration, errorText, samplesText } from './numbers.js';

const kSvg = 'http://www.w3.org/2000/svg';
const kHeight = 236;
const kLeft = 54;
const kRight = 14;
const kTop = 26;
const kBottom = 42;
const kLabelPx = { x: 46, y: 15 };
const kIndependent = -1 / 2;  // slope for samples that know nothing of each other

function svg(tag, attributes, ...children) {
  const element = document.createElementNS(kSvg, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

const timeTick = (ms) => (ms >= 1000 ? `${ms / 1000} s` : `${ms} ms`);
const path = (points, axes) => `M${points.map(({ x, y }) => `${px(axes.x.at(x))},${px(axes.y.at(y))}`).join('L')}`;
const px = (value) => value.toFixed(1);
const placed = (points) => points.map(({ ms, rmse }) => ({ x: ms, y: rmse }));

// `asked` = {rmse, time_ms} of the rules in force; either may be missing.
export function drawErrorPlot(plot, { current, before }, asked) {
  const width = plot.clientWidth || 320;
  plot.setAttribute('viewBox', `0 0 ${width} ${kHeight}`);
  plot.setAttribute('aria-label', describeCurve(current.points));
  const all = [...current.points, ...(before?.points ?? [])];
  plot.replaceChildren();
  if (all.length === 0) {
    plot.append(svg('text', { x: width / 2, y: kHeight / 2, class: 'is-middle' }, 'The curve begins with the second sample.'));
    return;
  }
  const axes = {
    x: logAxis([...all.map(({ ms }) => ms), ...present(asked.time_ms)], kLeft, width - kRight, kLabelPx.x),
    y: logAxis([...all.map(({ rmse }) => rmse), ...present(asked.rmse)], kHeight - kBottom, kTop, kLabelPx.y),
  };
  plot.append(grid(axes, width), ...goals(axes, asked, width));
  if (before) plot.append(svg('path', { class: 'plot-before', d: path(placed(before.points), axes) }));
  if (current.points.length === 0) return;
  plot.append(slope(axes, current.points[0]));
  plot.append(svg('path', { class: 'plot-line', d: path(placed(current.points), axes) }));
  current.points.forEach((point, i) => {
    const isEnd = current.isFinal && i === current.points.length - 1;
    plot.append(svg('circle', {
      class: isEnd ? 'plot-point is-end' : 'plot-point', cx: px(axes.x.at(point.ms)), cy: px(axes.y.at(point.rmse)), r: isEnd ? 5 : 3.5,
    }, svg('title', {}, `${samplesText(point.spp)}: error ${errorText(point.rmse)} after ${duration(point.ms)}`)));
  });
}

const present = (value) => (value > 0 ? [value] : []);

function grid(axes, width) {
  const group = svg('g', { class: 'plot-grid' });
  for (const { value, isLabelled } of axes.x.ticks) {
    const x = px(axes.x.at(value));
    group.append(svg('line', { x1: x, x2: x, y1: kTop, y2: kHeight - kBottom }));
    if (isLabelled) group.append(svg('text', { x, y: kHeight - kBottom + 17, class: 'is-middle' }, timeTick(value)));
  }
  for (const { value, isLabelled } of axes.y.ticks) {
    const y = axes.y.at(value);
    group.append(svg('line', { x1: kLeft, x2: width - kRight, y1: px(y), y2: px(y) }));
    if (isLabelled) group.append(svg('text', { x: kLeft - 8, y: px(y + 4), class: 'is-end' }, String(value)));
  }
  group.append(svg('text', { x: 0, y: 12, class: 'plot-axis' }, 'error'));
  group.append(svg('text', { x: width - kRight, y: kHeight - 6, class: 'plot-axis is-end' }, 'render time'));
  return group;
}

// How independent samples would go on from the first point.
function slope(axes, { ms, rmse }) {
  const line = slopeLine({ x: ms, y: rmse }, kIndependent, axes.x.high, axes.y.low);
  return svg('path', { class: 'plot-slope', d: path(line, axes) });
}

function goals(axes, asked, width) {
  const lines = [];
  if (asked.rmse > 0) {
    const y = px(axes.y.at(asked.rmse));
    lines.push(svg('line', { class: 'plot-asked', x1: kLeft, x2: width - kRight, y1: y, y2: y }));
  }
  if (asked.time_ms > 0) {
    const x = px(axes.x.at(asked.time_ms));
    lines.push(svg('line', { class: 'plot-asked', x1: x, x2: x, y1: kTop, y2: kHeight - kBottom }));
  }
  return lines;
}
