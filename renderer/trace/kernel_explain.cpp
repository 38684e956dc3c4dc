// SPDX-License-Identifier: Apache-2.0
#include "renderer/trace/tile_kernel.h"

namespace tilelight {

TileCounts explain(const CompiledScene& scene, const ViewPlan& plan, const EyeMedia& eye_media, const TileRect& rect,
                   uint32_t sample, RayListener& listener) {
  TileCounts counts;
  TileJob job;
  job.scene = &scene;
  job.plan = &plan;
  job.eye_media = &eye_media;
  job.rect = rect;
  job.first_sample = sample;
  job.counts = &counts;
  job.listener = &listener;
  TileKernel<Abilities{.mirrors = true, .glass = true, .shadows = true, .listens = true}>(job).run();
  return counts;
}

}  // namespace tilelight
