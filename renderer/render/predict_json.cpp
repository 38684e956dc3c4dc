// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "renderer/render/predict.h"

namespace tilelight {

std::string cost_json(const CostPrediction& cost) {
  return nlohmann::ordered_json{{"mrays", cost.mrays}, {"cpu_ms", cost.cpu_ms}, {"elapsed_ms", cost.elapsed_ms}}.dump();
}

}  // namespace tilelight
