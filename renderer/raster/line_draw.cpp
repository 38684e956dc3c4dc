// SPDX-License-Identifier: Apache-2.0
#include "renderer/raster/line_draw.h"

#include "renderer/trace/pixel_filter.h"

namespace tilelight {

void draw_ink(const LineInk& ink, const RenderSpec& spec, const TileJob& job) {
  constexpr float kInk = 0.01f, kPaper = 1.0f;  // linear, at exposure 0
  for (const CellWork& cell : job.cells) {
    if (job.cancelled && job.cancelled->load(std::memory_order_relaxed)) return;
    for (uint32_t index = cell.first; index < cell.first + cell.count; ++index) {
      for_each_pixel(cell.rect, [&](int x, int y) {
        const SamplePoint p = place_sample(spec, x, y, index);
        const float shade = ink.is_inked(x + p.x, y + p.y) ? kInk : kPaper;
        const float rgb[] = {shade, shade, shade};
        job.film->add(x, y, 1, index, rgb);
      });
    }
  }
  job.counts->is_complete = true;
}

}  // namespace tilelight
