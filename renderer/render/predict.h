// SPDX-License-Identifier: Apache-2.0
// predict_cost: what a render will cost and how good it will be, measured and not guessed, before it is queued.
#pragma once

#include <string>

#include "renderer/compile/compile.h"
#include "renderer/render/probe.h"

namespace tilelight {

// What the view's stop rules come to. The intervals hold in 95 % of cases on a machine that does nothing else.
struct CostPrediction {
  double spp = 0.0;         // samples a pixel, mean
  double mrays = 0.0;       // rays of all kinds, millions
  double cpu_ms = 0.0;      // on one thread
  double elapsed_ms = 0.0;  // on the pool's threads; with a time_ms no more than that or a sketch
  double elapsed_low_ms = 0.0, elapsed_high_ms = 0.0;
  double rmse = -1.0;  // as ErrorSummary has it; < 0: not known, for a sample is too dear to try
  double rmse_low = 0.0, rmse_high = 0.0;
  double probe_ms = 0.0;  // what asking took
};

// Traces a few thousand of the render's own samples on the calling thread (probe.h), and lets the schedule of passes
// run on what they tell. Methods that find by other means than rays what is seen shade as the tracer does, which is
// most of the work, and count as its equals. probe_budget_ms: as probe_view takes it.
CostPrediction predict_cost(const std::shared_ptr<const CompiledScene>& scene, const ViewPlan& plan, TilePool& pool,
                            double probe_budget_ms = kProbeMs);

// {"spp": ..., "mrays": ..., "cpu_ms": ..., "elapsed_ms": ..., "elapsed_ci95_ms": [low, high], "rmse": ... or null,
// "rmse_ci95": [low, high] or null, "probe_ms": ...}
std::string cost_json(const CostPrediction& cost);

}  // namespace tilelight
