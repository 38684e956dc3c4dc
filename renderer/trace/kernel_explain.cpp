// SPDX-License-Identifier: Apache-2.0
#include "renderer/trace/tile_kernel.h"

namespace tilelight {

TileCounts explain(const CompiledScene& scene, const ViewPlan& plan, const EyeMedia& eye_media, const TileRect& rect,
                   uint32_t sample, RayListener& listener) {
  TileCounts counts;
  std::vector<CellWork> rows;
  for (int y = rect.y0; y < rect.y1; ++y) rows.push_back({.rect = {rect.x0, y, rect.x1, y + 1}, .first = sample});
  const TileJob job{
      .scene = &scene, .plan = &plan, .eye_media = &eye_media, .cells = rows, .counts = &counts, .listener = &listener};
  TileKernel<Abilities{.mirrors = true, .glass = true, .shadows = true, .listens = true}>(job).run();
  return counts;
}

}  // namespace tilelight
