// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <nlohmann/json.hpp>

#include "renderer/study/study.h"
#include "renderer/study/tables.h"

namespace tilelight {
namespace {

using Json = nlohmann::ordered_json;

Json finite(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }
Json not_negative(double v) { return v < 0.0 ? Json(nullptr) : Json(v); }

Json json_of(const ImageError& e) {
  return {{"rmse", e.rmse}, {"p99", e.p99},  {"max", e.most}, {"rel_mse", e.rel_mse}, {"psnr_db", finite(e.psnr_db)},
          {"ssim", e.ssim}, {"flip", e.flip}};
}

Json json_of(const std::optional<PowerLaw>& law) {
  if (!law) return nullptr;
  return {{"slope", law->slope}, {"ci95", {law->low, law->high}}};
}

Json json_of(const StudyRun& run) {
  return {{"setting", run.setting},
          {"spp", run.spp},
          {"time_ms", run.time_ms},
          {"time_range_ms", {run.time_low_ms, run.time_high_ms}},
          {"cpu_ms", run.cpu_ms},
          {"error", json_of(run.error)},
          {"rmse_by_round", run.rmse_by_round},
          {"told_rmse", not_negative(run.told_rmse)},
          {"told_rounds", run.told_rounds},
          {"told_inside", run.told_inside},
          {"efficiency", finite(run.efficiency)},
          {"pareto", run.is_on_front}};
}

Json json_of(const StudySeries& series) {
  Json runs = Json::array();
  for (const StudyRun& run : series.runs) runs.push_back(json_of(run));
  return {{"name", series.name},
          {"method", series.method},
          {"shading", series.shading},
          {"sampling", series.sampling},
          {"precision", series.precision},
          {"slope_by_samples", json_of(series.by_samples)},
          {"slope_by_time", json_of(series.by_time)},
          {"runs", std::move(runs)}};
}

Json json_of(const std::vector<study::TableRow>& table, const Study& study, const char* at, const char* value) {
  Json rows = Json::array();
  for (const study::TableRow& row : table) {
    Json values;
    for (size_t i = 0; i < row.values.size(); ++i)
      values[study.series[i].name] = row.values[i] ? Json(*row.values[i]) : Json(nullptr);
    rows.push_back({{at, row.at}, {value, std::move(values)}});
  }
  return rows;
}

}  // namespace

std::string study_json(const Study& study) {
  Json series = Json::array(), knobs = Json::array(), oracle = Json::array();
  for (const StudySeries& s : study.series) series.push_back(json_of(s));
  for (const KnobRow& row : study.knobs) {
    knobs.push_back({{"knob", row.knob},
                     {"value", row.value},
                     {"of_scene", row.is_of_scene},
                     {"exact", row.is_exact},
                     {"time_ms", row.time_ms},
                     {"rmse", row.rmse},
                     {"truncation", row.truncation},
                     {"truncation_bound", not_negative(row.truncation_bound)}});
  }
  for (const OracleRow& row : study.oracle) {
    oracle.push_back({{"rule", row.rule},
                      {"predicted", Json::parse(cost_json(row.predicted))},
                      {"elapsed_ms", row.elapsed_ms},
                      {"rmse", row.rmse},
                      {"time_inside", row.is_time_inside},
                      {"rmse_inside", row.is_rmse_inside ? Json(*row.is_rmse_inside) : Json(nullptr)}});
  }
  Json trials = Json::array();
  for (const PeerTrial& trial : study.peer_trials) {
    trials.push_back({{"setting", trial.setting},
                      {"spp", trial.spp},
                      {"time_ms", trial.time_ms},
                      {"cpu_ms", trial.cpu_ms},
                      {"rmse", trial.rmse},
                      {"pareto", trial.is_on_front}});
  }
  const Json out = {
      {"scene", study.scene_name},
      {"scene_sha256", study.scene_id},
      {"width", study.width},
      {"height", study.height},
      {"exposure", study.exposure},
      {"rounds", study.rounds},
      {"threads", study.threads},
      {"isa", study.isa},
      {"kernel", study.kernel},
      {"compile_ms", study.compile_ms},
      {"reference",
       {{"spp", study.reference_samples}, {"rmse", study.reference_rmse}, {"least_rmse_of_runs", study.least_rmse}}},
      {"series", std::move(series)},
      {"equal_time", json_of(study::equal_time(study), study, "time_ms", "rmse")},
      {"equal_error", json_of(study::equal_error(study), study, "rmse", "time_ms")},
      {"knobs", std::move(knobs)},
      {"components",
       {{"sampling_rmse", study.components.sampling},
        {"truncation_bound", not_negative(study.components.truncation_bound)},
        {"rounding_rmse", study.components.rounding},
        {"quantisation_rmse", study.components.quantisation}}},
      {"oracle", std::move(oracle)},
      {"peer_trials", std::move(trials)},
      {"notes", study.notes}};
  return out.dump(2) + "\n";
}

}  // namespace tilelight
