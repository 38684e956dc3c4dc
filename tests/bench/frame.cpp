// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/frame.h"

#include <vector>

#include "renderer/trace/tile_job.h"

namespace tilelight::bench {

void render_frame(const CompiledScene& scene, const ViewPlan& plan, TilePool& pool, Film& film) {
  constexpr int kTilePx = 32;
  const ImageSpec& image = plan.view.image;
  const EyeMedia eye_media(scene, plan);
  const Kernel kernel = kernel_of(plan.variant);
  pool.parallel_for(tile_count(image.width, image.height, kTilePx), Priority::normal, [&](int64_t i) {
    std::vector<CellWork> cells;
    for_each_cell(tile_rect(static_cast<int>(i), image.width, image.height, kTilePx),
                  [&](const TileRect& cell) { cells.push_back({.rect = cell}); });
    TileView view = film.view();
    TileCounts counts;
    kernel({.scene = &scene, .plan = &plan, .eye_media = &eye_media, .film = &view, .cells = cells, .counts = &counts});
  });
}

}  // namespace tilelight::bench
