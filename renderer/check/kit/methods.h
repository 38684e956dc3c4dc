// SPDX-License-Identifier: Apache-2.0
// DrawnScene: a view as the hidden-surface methods draw it, from triangles, with samples on the grid of 1/256 pixel:
// what its samples see by rays, by the z-buffer and by Warnock's subdivision. Any thread.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "renderer/compile/compile.h"
#include "renderer/raster/visible_window.h"
#include "renderer/scene/parse.h"

namespace tilelight::check {

// What rays see that pass a sample by half a step of the grid in x, in y or in both, which is how far rounding moves a
// corner: all the same as the sample's own ray, or another triangle of its body, or another body.
enum class Beside : uint8_t { same, other_triangle, other_body };

class DrawnScene {
 public:
  DrawnScene(const ParsedScene& parsed, TilePool& pool);
  const CompiledScene& scene() const { return *scene_; }
  const ViewPlan& plan() const { return plan_; }
  TilePool& pool() const { return pool_; }

  // By pixel what its first sample sees, as surface_id; by rays for what is not drawn from triangles.
  std::vector<uint64_t> ids(Algorithm algorithm) const;
  // By pixel, about its first sample: that of the rays which differs most. No edge that passes by unseen counts.
  std::vector<Beside> beside() const;

 private:
  std::vector<uint64_t> ids_by_rays(double dx, double dy) const;

  TilePool& pool_;
  ViewPlan plan_;
  std::shared_ptr<const CompiledScene> scene_;
};

// Every pixel of a window gets its sample by place(x, y), in steps of the grid from the picture's first corner. x0, y0:
// the window's first pixel.
void place_samples(const ImageSpec& image, int x0, int y0, const std::function<Vec2(int, int)>& place,
                   VisibleWindow& window);

}  // namespace tilelight::check
