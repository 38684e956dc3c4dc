// SPDX-License-Identifier: Apache-2.0
// Logarithmic axes for a plot: from values to places, and ticks that a reader knows: 1, 2 and 5 of a decade. Pure.

const kLeastDecades = 0.6;  // so that a curve of two points does not look like a cliff
const kDigits = [1, 2, 5, 10];
const kSlack = 1e-9;        // of a decade: 0.001 is its own tick, whatever its bits

// The axis that holds `values` (all > 0) between two ticks, from `start` to `end` in pixels. Labels are at least
// `labelPx` apart.
export function logAxis(values, start, end, labelPx) {
  let low = tickBeside(Math.min(...values), -1);
  let high = tickBeside(Math.max(...values), 1);
  while (Math.log10(high / low) < kLeastDecades) {
    low = tickBeside(low * 0.99, -1);
    high = tickBeside(high * 1.01, 1);
  }
  const lowLog = Math.log10(low);
  const pxPerDecade = (end - start) / (Math.log10(high) - lowLog);
  const at = (value) => start + (Math.log10(value) - lowLog) * pxPerDecade;
  return { low, high, at, ticks: ticksOf(low, high, Math.abs(pxPerDecade), labelPx) };
}

// A line of a given slope in the logarithms, through `from` and as far as the axes go: [from, to].
export function slopeLine(from, slope, xHigh, yLow) {
  const yEnd = from.y * (xHigh / from.x) ** slope;
  const to = yEnd >= yLow ? { x: xHigh, y: yEnd } : { x: from.x * (yLow / from.y) ** (1 / slope), y: yLow };
  return [from, to];
}

// The next tick at or below (direction -1) or at or above (1) a value.
function tickBeside(value, direction) {
  const decade = Math.floor(Math.log10(value) + kSlack);
  const all = [decade - 1, decade, decade + 1].flatMap((d) => kDigits.slice(0, 3).map((digit) => tick(digit, d)));
  const log = Math.log10(value);
  if (direction < 0) return all.filter((t) => Math.log10(t) <= log + kSlack).at(-1);
  return all.find((t) => Math.log10(t) >= log - kSlack);
}

// By its digits, as 2 * 10 ** -3 has other bits than 0.002.
function tick(digit, decade) {
  return Number(`${digit}e${decade}`);
}

// [{value, isLabelled}]: all get a label where there is room, else the decades, else some of them.
function ticksOf(low, high, pxPerDecade, labelPx) {
  const hasRoom = pxPerDecade * Math.log10(2) >= labelPx;
  const everyDecade = Math.ceil(labelPx / pxPerDecade);
  const first = Math.floor(Math.log10(low) + kSlack);
  const ticks = [];
  for (let decade = first; tick(1, decade) <= high * (1 + kSlack); ++decade) {
    for (const digit of kDigits.slice(0, 3)) {
      const value = tick(digit, decade);
      if (value < low * (1 - kSlack) || value > high * (1 + kSlack)) continue;
      ticks.push({ value, isLabelled: hasRoom || (digit === 1 && decade % everyDecade === 0) });
    }
  }
  if (!ticks.some(({ isLabelled }) => isLabelled)) ticks.forEach((t, i) => { t.isLabelled = i % (ticks.length - 1) === 0; });
  return ticks;
}
