// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "renderer/base/characters.h"
#include "renderer/base/hash.h"
#include "renderer/render/render.h"

namespace tilelight {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kByteRmse = 1.1321e-3;  // of rounding to 8 bits: 1 / (255 sqrt 12)

Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

// Where the error of the last point comes from, rmse but for the bound.
Json components_json(const ReportPoint& p, const std::optional<double>& rounding) {
  return {{"sampling", p.error.is_known ? Json(p.error.rmse) : Json(nullptr)},
          {"truncation_bound", p.truncation_bound < 0.0 ? Json(nullptr) : Json(p.truncation_bound)},
          {"rounding", rounding ? Json(*rounding) : Json(nullptr)},
          {"quantisation", kByteRmse}};
}

// 1 / (mse s).
Json efficiency_json(const ReportPoint& p) {
  const double cost = p.error.rmse * p.error.rmse * 1e-3 * p.elapsed_ms;
  return p.error.is_known && cost > 0.0 ? Json(1.0 / cost) : Json(nullptr);
}

}  // namespace

std::vector<SceneWarning> report_warnings(const RenderReport& report) {
  const int64_t count = report.points.empty() ? 0 : report.points.back().nonfinite;
  if (count == 0) return {};
  return {{"", "nonfinite",
           std::to_string(count) + (count == 1 ? " sample was" : " samples were") +
               " not finite, or over 1e34, and count as black; less light, or less of it reflected, keeps them"}};
}

std::string image_hash(const Image& image) {
  return sha256_hex({reinterpret_cast<const char*>(image.rgb.data()), image.rgb.size() * sizeof(float)});
}

std::string report_json(const RenderReport& report, const Plan& plan, const ReportIdentity& identity) {
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
  const bool has_points = !report.points.empty();
  auto warnings = identity.warnings;
  for (SceneWarning& warning : report_warnings(report)) warnings.push_back(std::move(warning));
  const Json out = {
      {"points", points},
      {"stop", report.stop},
      {"adaptive", report.adaptive},
      {"passes", report.passes},
      {"components", has_points ? components_json(report.points.back(), identity.rounding) : Json(nullptr)},
      {"efficiency", has_points ? efficiency_json(report.points.back()) : Json(nullptr)},
      {"stiffness", Json::parse(plan_json(plan)).at("stiffness")},
      {"warnings", Json::parse(warnings_json(warnings, plan.warnings))},
      {"clamped", identity.clamped ? Json(*identity.clamped) : Json(nullptr)},
      {"image_hash", text_or_null(identity.image_hash)},
      {"version", text_or_null(identity.version)},
      {"scene_sha256", text_or_null(identity.scene_id)},
      {"seed", report.seed},
      {"threads", report.threads},
      {"kernel", plan.kernel},
      {"isa", plan.isa}};
  return printable_json(out.dump());
}

}  // namespace tilelight
