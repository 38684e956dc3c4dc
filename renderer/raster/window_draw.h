// SPDX-License-Identifier: Apache-2.0
// What the z-buffer and Warnock's subdivision share: work items cut into windows, several samples of each, and the hits
// that shading goes on from. Shading is the tracer's own, with its shadow rays; only who is seen is found here.
#pragma once

#include "renderer/raster/visible_window.h"
#include "renderer/trace/tile_job.h"

namespace tilelight {

// Finds what the samples of a window see, given as RasterScene::in_window gives them, and returns the list that the
// owners are places in.
class WindowFinder {
 public:
  virtual ~WindowFinder() = default;
  virtual std::span<const RasterPrim* const> find(int x, int y, std::span<VisibleWindow> layers) const = 0;
};

void draw_windows(const RasterScene& raster, const WindowFinder& finder, const TileJob& job);

// Where a ray meets a primitive that its sample sees. Rays that pass just beside a triangle, whose corners lie on a
// grid, meet its plane, and count as meeting its rim.
Hit hit_of(const CompiledScene& scene, uint32_t body, uint32_t prim, const Ray& ray);

}  // namespace tilelight
