// SPDX-License-Identifier: Apache-2.0
// A probe of a render: some of its own samples, traced before it is queued, which tell what the others will cost and
// how fast their error will fall.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/compile/compile.h"

namespace tilelight {

struct Probe {
  double rays_per_sample = 0.0, ms_per_ray = 0.0;  // on one thread
  // By spot, pixels all over the image with kProbeSamples samples each; none where a sample is too dear.
  std::vector<double> variances;  // of displayed - true, after so many samples
  std::vector<double> costs;      // rays of a sample over the mean of all spots
  double decay = 1.0;             // of a variance, when samples are doubled
  double image_part = 0.0;        // of the image that the spots cover
};
inline constexpr uint32_t kProbeSamples = 16;

inline constexpr double kProbeMs = 40.0;

// scene: as drawn_scene gives it. budget_ms: the calling thread's own time after which no more is traced; a probe that
// ends within it tells the same rays and variances every time. Most scenes take some 10 ms, and one whose samples are
// very dear eight of them at least.
Probe probe_view(const CompiledScene& scene, const ViewPlan& plan, double budget_ms = kProbeMs);

}  // namespace tilelight
