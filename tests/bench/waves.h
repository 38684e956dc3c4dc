// SPDX-License-Identifier: Apache-2.0
// Waves: every ray that a Whitted frame asks a tracer for, in the batches and the order in which the renderer asks, so
// that several tracers can be timed on the same rays. And the frame itself, without a film.
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

struct FrameSpec {
  int max_depth = 0;
  int shadow_lights = 0;  // the first so many lights cast shadows; the rest of them light without
};

// The waves of one sample a pixel: primary rays, their shadow rays light by light, the first reflections, ...
// REQUIRES: nothing in the scene lets light through.
std::vector<Wave> waves_of(const CompiledScene& scene, const ViewPlan& plan, const FrameSpec& spec, TilePool& pool);

// The same work with its shading, tile by tile. Returns a sum of all radiance, so that nothing is optimised away.
double shade_frame(const CompiledScene& scene, const ViewPlan& plan, const FrameSpec& spec, TilePool& pool);

// Both by our own tracer.
void trace_waves(const CompiledScene& scene, const std::vector<Wave>& waves, TilePool& pool);

}  // namespace tilelight::bench
