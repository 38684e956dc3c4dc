// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "renderer/render/render.h"

namespace tilelight {

std::string report_json(const RenderReport& report, const Plan& plan) {
  using Json = nlohmann::ordered_json;
  Json points = Json::array();
  for (const ReportPoint& p : report.points) {
    const auto known = [&p](double value) { return p.error.is_known ? Json(value) : Json(nullptr); };
    points.push_back({{"pass", p.pass},
                      {"spp", p.spp},
                      {"elapsed_ms", p.elapsed_ms},
                      {"cpu_ms", p.cpu_ms},
                      {"rays",
                       {{"primary", p.rays.primary},
                        {"shadow", p.rays.shadow},
                        {"reflected", p.rays.reflected},
                        {"refracted", p.rays.refracted}}},
                      {"rmse", known(p.error.rmse)},
                      {"rmse_ci95", p.error.is_known ? Json{p.error.low, p.error.high} : Json(nullptr)},
                      {"est_p99", known(p.error.p99)},
                      {"est_max", known(p.error.most)},
                      {"unconverged", p.error.is_known ? Json(p.error.unconverged) : Json(nullptr)},
                      {"truncation_bound", p.truncation_bound < 0.0 ? Json(nullptr) : Json(p.truncation_bound)},
                      {"nonfinite", p.nonfinite},
                      {"lights_on_hits", p.lights_on_hits}});
  }
  const Json out = {{"points", points},        {"stop", report.stop},       {"adaptive", report.adaptive},
                    {"passes", report.passes}, {"threads", report.threads}, {"kernel", plan.kernel},
                    {"isa", plan.isa}};
  return out.dump();
}

}  // namespace tilelight
