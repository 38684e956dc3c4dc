// SPDX-License-Identifier: Apache-2.0
// Waves: every ray that a Whitted frame asks a tracer for, in the batches and the order in which the renderer asks, so
// that several tracers can be timed on the same rays.
#pragma once

#include <string>
#include <vector>

#include "renderer/renderer.h"
#include "renderer/trace/trace_rays.h"

namespace tilelight::bench {

// Rays that are asked for together: of a few hundred neighbouring pixels, and of one light if they are shadow rays.
struct Wave {
  int depth = 0;         // reflections before
  bool any_hit = false;  // shadow rays
  std::vector<BoundedRay> rays;
};
// The waves of some pixels: primary rays, their shadow rays light by light, the first reflections, ... as deep as the
// view has them.
using PixelWaves = std::vector<Wave>;
using FrameWaves = std::vector<PixelWaves>;

// The primary rays of one sample a pixel, as many together as a kernel takes.
std::vector<std::vector<BoundedRay>> primary_rays(const ViewPlan& plan);

// Of one sample a pixel. REQUIRES: nothing in the scene lets light through.
FrameWaves waves_of(const CompiledScene& scene, const ViewPlan& plan, TilePool& pool);

// One kind of rays of a frame.
struct WaveKind {
  int depth = 0;
  bool any_hit = false;
  int64_t rays = 0;

  std::string name() const;  // as "depth 1 shadow"
};
std::vector<WaveKind> kinds_of(const FrameWaves& frame);
// The rays of one kind alone, of every n-th pixels that have some.
FrameWaves only(const FrameWaves& frame, const WaveKind& kind, size_t every);

// By our own tracer, with all threads of the pool; seconds that a thread took on average. Rays lie in the cache, as
// they do where a kernel has just made them.
double trace_waves(const CompiledScene& scene, const FrameWaves& frame, TilePool& pool);

}  // namespace tilelight::bench
