// SPDX-License-Identifier: Apache-2.0
// VisibleWindow: what one sample of every pixel of a window sees. The z-buffer and Warnock's subdivision both fill it,
// each in its own way and with the same answer. One thread.
#pragma once

#include <limits>
#include <vector>

#include "renderer/raster/raster_scene.h"

namespace tilelight {

struct VisibleWindow {
  static constexpr size_t kPixels = static_cast<size_t>(kWindowPx) * kWindowPx;

  // Row by row, the window's first pixel first. Places are steps of the grid; not a number where no sample is asked
  // for. Owners are places in the list of primitives, kNone for the background.
  alignas(64) double x[kPixels], y[kPixels];
  // Of what covers the sample: the largest nearness that is certain, and the largest that may be.
  alignas(64) double front[kPixels], most[kPixels];
  alignas(64) uint32_t owner[kPixels];

  static size_t at(int dx, int dy) { return static_cast<size_t>(dy) * kWindowPx + static_cast<size_t>(dx); }
  void clear() {
    std::fill_n(x, kPixels, std::numeric_limits<double>::quiet_NaN());
    std::fill_n(y, kPixels, 0.0);
    std::fill_n(front, kPixels, -std::numeric_limits<double>::infinity());
    std::fill_n(most, kPixels, -std::numeric_limits<double>::infinity());
    std::fill_n(owner, kPixels, kNone);
  }
};

}  // namespace tilelight
