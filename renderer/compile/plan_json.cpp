// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "renderer/compile/plan.h"

namespace tilelight {

std::string plan_json(const Plan& plan) {
  using Json = nlohmann::ordered_json;
  const auto vec = [](const Vec3& v) { return Json{v.x, v.y, v.z}; };
  Json features = Json::array();
  for (int i = 0; i < kFeatureCount; ++i) {
    const auto feature = static_cast<Feature>(i);
    if (plan.features.has(feature)) features.push_back(feature_name(feature));
  }
  Json left_out = Json::array();
  for (const LeftOut& item : plan.left_out) {
    left_out.push_back({{"what", item.what}, {"why", item.why}});
    if (!item.cost.empty()) left_out.back()["cost"] = item.cost;
  }
  const Json out = {{"features", features},
                    {"kernel", plan.kernel},
                    {"isa", plan.isa},
                    {"left_out", left_out},
                    {"bodies", plan.bodies},
                    {"lights", plan.lights},
                    {"triangles", {{"stored", plan.triangles_stored}, {"instanced", plan.triangles_instanced}}},
                    {"memory_bytes", plan.memory_bytes},
                    {"bounds", {{"min", vec(plan.bounds_min)}, {"max", vec(plan.bounds_max)}}},
                    {"stiffness",
                     {{"extent", plan.stiffness.extent},
                      {"offset_ratio", plan.stiffness.offset_ratio},
                      {"size_ratio", plan.stiffness.size_ratio},
                      {"n_max", plan.stiffness.shininess},
                      {"intensity_ratio", plan.stiffness.intensity_ratio}}},
                    {"compile_ms", plan.compile_ms},
                    {"plan_ms", plan.plan_ms}};
  return out.dump();
}

std::string warnings_json(const std::vector<SceneWarning>& read, const std::vector<SceneWarning>& planned) {
  using Json = nlohmann::ordered_json;
  Json out = Json::array();
  for (const auto* found : {&read, &planned}) {
    for (const SceneWarning& w : *found)
      out.push_back({{"pointer", w.pointer}, {"code", w.code}, {"detail", w.detail}});
  }
  return out.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace tilelight
