// SPDX-License-Identifier: Apache-2.0
// predict_cost: what a render will cost, measured and not guessed, before it is queued.
#pragma once

#include <string>

#include "renderer/compile/compile.h"

namespace tilelight {

struct CostPrediction {
  double mrays = 0.0;       // rays of all kinds, millions
  double cpu_ms = 0.0;      // on one thread
  double elapsed_ms = 0.0;  // on `threads`, nothing else running; never more than the view's time_ms
};

// Traces one sample a cell of a coarse grid over the view's image, on the calling thread, and scales up: about a
// thousand samples, so a few milliseconds for most scenes and a few hundred for glass that spends its ray budget. Good
// to about a tenth for rays; times are those of this machine as it is now.
CostPrediction predict_cost(const CompiledScene& scene, const ViewPlan& plan, int threads);

// {"mrays": ..., "cpu_ms": ..., "elapsed_ms": ...}
std::string cost_json(const CostPrediction& cost);

}  // namespace tilelight
