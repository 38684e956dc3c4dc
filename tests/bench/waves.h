// SPDX-License-Identifier: Apache-2.0
// Waves: every ray that a Whitted frame asks a tracer for, in the batches and the order in which the renderer asks, so
// that several tracers can be timed on the same rays.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "renderer/renderer.h"
#include "renderer/trace/trace_rays.h"

namespace tilelight::bench {

using Batch = std::vector<BoundedRay>;

struct Wave {
  int depth = 0;         // reflections before
  bool any_hit = false;  // shadow rays
  std::vector<Batch> batches;

  int64_t rays() const;
};

// The waves of one sample a pixel: primary rays, their shadow rays light by light, the first reflections, ... as deep
// as the plan's view has them. REQUIRES: nothing in the scene lets light through.
std::vector<Wave> waves_of(const CompiledScene& scene, const ViewPlan& plan, TilePool& pool);

// By our own tracer.
void trace_waves(const CompiledScene& scene, const std::vector<Wave>& waves, TilePool& pool);

}  // namespace tilelight::bench
