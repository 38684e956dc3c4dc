// SPDX-License-Identifier: Apache-2.0
// How many pixels to ask for: all of them when still, as many as the server draws in time while moving.

const kMaxPixelRatio = 2;
const kMaxPixels = 4e6;       // 2560 x 1600: above it a finer picture shows little and costs the same again
export const kTargetMs = 60;  // from asking to seeing while moving: 15 frames a second and a little to spare
const kLeastRenderMs = 20;    // of the target; what is left when the way to the server takes the rest
const kMinScale = 0.15;
const kMaxScale = 1;

export function fullSize(cssWidth, cssHeight, pixelRatio) {
  const wanted = Math.min(pixelRatio, kMaxPixelRatio);
  const ratio = Math.min(wanted, Math.sqrt(kMaxPixels / Math.max(1, cssWidth * cssHeight)));
  return scaledSize({ width: cssWidth, height: cssHeight }, ratio);
}

export function scaledSize(size, scale) {
  return { width: Math.max(1, Math.round(size.width * scale)), height: Math.max(1, Math.round(size.height * scale)) };
}

// The share of the full width and height for the next moving view, from what the last one took. `renderMs` is the
// server's part of `latencyMs`; only that part follows the number of pixels.
export function nextScale(scale, latencyMs, renderMs = latencyMs) {
  const render = Math.max(0.5, Math.min(renderMs, latencyMs));
  const allowed = Math.max(kLeastRenderMs, kTargetMs - (latencyMs - render));
  const change = Math.min(1.25, Math.max(0.6, Math.sqrt(allowed / render)));
  return Math.min(kMaxScale, Math.max(kMinScale, scale * change));
}
