// SPDX-License-Identifier: Apache-2.0
// judge_view: one sample a pixel of a view by the fast renderer and by the reference, and how far they are apart.
#pragma once

#include <vector>

#include "renderer/measure/metrics.h"
#include "renderer/scene/scene.h"
#include "renderer/schedule/tile_pool.h"

namespace tilelight {

// The bounds of the comparison, as parts of all pixels.
inline constexpr double kMaxIdMismatchRate = 1e-4;
inline constexpr double kMaxQ8Rate = 5e-4;

struct Verdict {
  int width = 0, height = 0;  // pixels
  ShownImage fast, shown_reference;
  std::vector<ReferencePixel> reference;
  ImageDifference difference;
  int64_t fast_nonfinite = 0;                // samples of the fast renderer that were not finite
  double fast_ms = 0.0, reference_ms = 0.0;  // of the tracing alone, wall time

  bool passes() const {
    return difference.id_mismatch_rate() <= kMaxIdMismatchRate && difference.q8_rate() <= kMaxQ8Rate;
  }
};

// The view's stop rules are replaced by one sample a pixel. Calls the pool from this thread and waits for it.
Verdict judge_view(const Scene& scene, View view, TilePool& pool);

}  // namespace tilelight
