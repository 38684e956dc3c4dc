// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "renderer/study/compare.h"

namespace tilelight {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const CompareRow& row) {
  Json out = {{"method", row.method},
              {"shading", row.shading.empty() ? Json(nullptr) : Json(row.shading)},
              {"time_ms", row.time_ms},
              {"time_range_ms", {row.time_low_ms, row.time_high_ms}},
              {"memory_bytes", row.memory_bytes}};
  if (row.shading.empty()) return out;
  out["rays"] = {{"primary", row.rays.primary},
                 {"shadow", row.rays.shadow},
                 {"reflected", row.rays.reflected},
                 {"refracted", row.rays.refracted}};
  out["to_whole_light"] = {{"rmse", row.error.rmse},
                           {"p99", row.error.p99},
                           {"max", row.error.most},
                           {"ssim", row.error.ssim},
                           {"flip", row.error.flip}};
  if (row.to_rays)
    out["to_rays"] = {
        {"differing_part", row.to_rays->part}, {"rms", row.to_rays->rms}, {"max_8bit", row.to_rays->most}};
  return out;
}

}  // namespace

std::string comparison_json(const Comparison& c) {
  Json rows = Json::array(), works = Json::object();
  for (const CompareRow& row : c.rows) rows.push_back(json_of(row));
  for (const CompareWork& w : c.works) {
    for (const MethodWork::Count& count : w.work.counts) works[w.method][count.name] = count.value;
  }
  const Json out = {{"scene", c.scene_name},
                    {"scene_sha256", c.scene_id},
                    {"isa", c.isa},
                    {"threads", c.threads},
                    {"width", c.width},
                    {"height", c.height},
                    {"samples", c.samples},
                    {"rounds", c.rounds},
                    {"reference_samples", c.reference_samples},
                    {"rows", std::move(rows)},
                    {"work_per_sample", std::move(works)}};
  return out.dump(1) + "\n";
}

}  // namespace tilelight
