// SPDX-License-Identifier: Apache-2.0
// The pixels of the PNGs that the command writes: 8 bits a channel, not interlaced.
import { inflateSync } from 'node:zlib';

// {width, height, rgb}: rows from the top, 3 bytes a pixel.
export function readPng(bytes) {
  const width = bytes.readUInt32BE(16), height = bytes.readUInt32BE(20);
  const channels = { 0: 1, 2: 3 }[bytes[25]];
  if (bytes[24] !== 8 || !channels || bytes[28] !== 0) throw new Error('a PNG of another kind');
  const parts = [];
  for (let at = 8; at < bytes.length; at += 12 + bytes.readUInt32BE(at)) {
    if (bytes.toString('latin1', at + 4, at + 8) === 'IDAT') parts.push(bytes.subarray(at + 8, at + 8 + bytes.readUInt32BE(at)));
  }
  const rows = unfiltered(inflateSync(Buffer.concat(parts)), width * channels, height, channels);
  const rgb = Buffer.alloc(3 * width * height);
  for (let i = 0; i < rgb.length; ++i) rgb[i] = channels === 3 ? rows[i] : rows[Math.floor(i / 3)];
  return { width, height, rgb };
}

// RFC 2083, 6: every row begins with its filter.
function unfiltered(raw, stride, height, step) {
  const out = Buffer.alloc(stride * height);
  for (let y = 0; y < height; ++y) {
    const filter = raw[y * (stride + 1)];
    for (let x = 0; x < stride; ++x) {
      const i = y * stride + x;
      const left = x < step ? 0 : out[i - step], up = y === 0 ? 0 : out[i - stride];
      const corner = x < step || y === 0 ? 0 : out[i - stride - step];
      const guess = [0, left, up, (left + up) >> 1, paeth(left, up, corner)][filter];
      out[i] = raw[i + y + 1] + guess;
    }
  }
  return out;
}

function paeth(left, up, corner) {
  const guess = left + up - corner;
  const [toLeft, toUp, toCorner] = [left, up, corner].map((value) => Math.abs(guess - value));
  if (toLeft <= toUp && toLeft <= toCorner) return left;
  return toUp <= toCorner ? up : corner;
}
