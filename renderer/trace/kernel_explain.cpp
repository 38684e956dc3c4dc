// SPDX-License-Identifier: Apache-2.0
#include "renderer/trace/tile_kernel.h"

namespace tilelight {

TileCounts explain(const CompiledScene& scene, const ViewPlan& plan, const EyeMedia& eye_media, const TileRect& rect,
                   uint32_t sample, RayListener& listener) {
  TileCounts counts;
  const TileJob job{.scene = &scene,
                    .plan = &plan,
                    .eye_media = &eye_media,
                    .rect = rect,
                    .first_sample = sample,
                    .counts = &counts,
                    .listener = &listener};
  TileKernel<Abilities{.mirrors = true, .glass = true, .shadows = true, .listens = true}>(job).run();
  return counts;
}

}  // namespace tilelight
