// SPDX-License-Identifier: Apache-2.0
// Warnock's subdivision (Warnock 1969): a window of the image is looked at with the primitives that may meet it. If it
// is easy (nothing is there, one primitive alone, or one that surrounds it in front of all others) it is drawn; else it
// is cut into four, each with what may still be seen in it, down to the pixel, where the sample rule decides. All that
// is decided before is certain for every sample that a pixel can have, so the picture is the z-buffer's, bit for bit.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "renderer/raster/visible_window.h"

namespace tilelight {

using PrimList = std::vector<const RasterPrim*>;

// How a primitive lies to a window.
enum class Lie : uint8_t { disjoint, contained, intersecting, surrounding };
// reach_px: how far samples may lie outside the window. Exact, but that `intersecting` may be said of what is disjoint.
Lie lie_of(const RasterPrim& prim, const TileRect& window, int reach_px);

// What became of a window.
enum class Outcome : uint8_t { empty, single, surrounded, pixel, divided };

struct WarnockCounts {
  int64_t windows = 0;  // looked at
  int64_t divided = 0;  // of them cut into four
  int64_t empty = 0, single = 0, surrounded = 0;
  int64_t pixels = 0;          // windows of one pixel in which the sample rule had to decide
  int depth = 0;               // of the deepest window; the image's is 0
  int64_t looks = 0;           // at a primitive in a window
  int64_t settled_pixels = 0;  // that no sample rule was asked for: they lay in easy windows
};

// Called for every window that is not divided. Only the primitives that may be seen in it are in the list: those of
// `surrounded` are that one alone.
using OnWindow = std::function<void(const TileRect&, Outcome, int depth, const PrimList&)>;

// Divides the window, which lies `depth` cuts below the image's, until nothing is left to divide. A window's edge is a
// power of two, but for what the image cuts off it.
void subdivide(const TileRect& window, int depth, const PrimList& prims, int reach_px, WarnockCounts& counts,
               const OnWindow& on_window);

// Warnock's method for a whole view, from the image's own window down.
class WarnockScene {
 public:
  // Divides down to windows of kWindowPx, on the calling thread and on idle ones. Throws Stopped soon after
  // `stop` is set.
  WarnockScene(const RasterScene& raster, TilePool& pool, const std::atomic<bool>* stop = nullptr);

  // Fills the samples of a window, given as in RasterScene::in_window, in all layers. Owners are places in the list
  // that is returned.
  std::span<const RasterPrim* const> draw(int x, int y, std::span<VisibleWindow> layers) const;
  int64_t memory_bytes() const;

  // The whole subdivision once more, for those who want to see it.
  WarnockCounts visit(const OnWindow& on_window) const;

 private:
  TileRect root() const;

  const RasterScene& raster_;
  int windows_across_ = 0;
  std::vector<PrimList> lists_;  // by window: what may be seen in it
};

}  // namespace tilelight
