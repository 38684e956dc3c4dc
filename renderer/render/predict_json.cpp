// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "renderer/render/predict.h"

namespace tilelight {

std::string cost_json(const CostPrediction& cost) {
  using Json = nlohmann::ordered_json;
  const bool is_known = cost.rmse >= 0.0;
  return Json{{"spp", cost.spp},
              {"mrays", cost.mrays},
              {"cpu_ms", cost.cpu_ms},
              {"elapsed_ms", cost.elapsed_ms},
              {"elapsed_ci95_ms", {cost.elapsed_low_ms, cost.elapsed_high_ms}},
              {"rmse", is_known ? Json(cost.rmse) : Json(nullptr)},
              {"rmse_ci95", is_known ? Json{cost.rmse_low, cost.rmse_high} : Json(nullptr)},
              {"probe_ms", cost.probe_ms}}
      .dump();
}

}  // namespace tilelight
