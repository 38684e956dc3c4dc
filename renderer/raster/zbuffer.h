// SPDX-License-Identifier: Apache-2.0
// The z-buffer (Catmull 1974): every primitive of a window is drawn in turn, and each sample keeps the nearest.
#pragma once

#include <span>

#include "renderer/raster/visible_window.h"

namespace tilelight {

// Draws the primitives, in the order of their ranks, over a cleared window with its samples placed. x0, y0: the
// window's first pixel. Returns how often a sample was covered. Compiled for several instruction sets, all with the
// same bits.
int64_t draw_depths(std::span<const RasterPrim* const> prims, int x0, int y0, VisibleWindow& window);

}  // namespace tilelight
