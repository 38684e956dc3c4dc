// SPDX-License-Identifier: Apache-2.0
// predict_cost: what a render will cost, measured and not guessed, before it is queued.
#pragma once

#include <string>

#include "renderer/compile/compile.h"

namespace tilelight {

struct CostPrediction {
  double mrays = 0.0;       // rays of all kinds, millions
  double cpu_ms = 0.0;      // on one thread
  double elapsed_ms = 0.0;  // on `threads`, nothing else running; with a time_ms no more than that or the first pass
};

// Traces a few thousand of the render's own samples on the calling thread and scales up: some ten milliseconds for most
// scenes, and for glass that spends its ray budget no more than 0.1 s and eight samples. Good to about a tenth for
// rays; times are those of this machine as it is now.
CostPrediction predict_cost(const CompiledScene& scene, const ViewPlan& plan, int threads);

// {"mrays": ..., "cpu_ms": ..., "elapsed_ms": ...}
std::string cost_json(const CostPrediction& cost);

}  // namespace tilelight
