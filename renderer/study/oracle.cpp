// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "renderer/study/studio.h"

namespace tilelight::study {
namespace {

struct Rule {
  std::string name;
  View view;
};

std::string text(const char* format, double value) {
  char out[64];
  std::snprintf(out, sizeof out, format, value);
  return out;
}

// Some of every kind, over the range that the uniform runs have: by samples, error and time.
std::vector<Rule> rules_of(const View& view, const StudySeries& uniform) {
  std::vector<Rule> rules;
  for (const StudyRun& run : uniform.runs) {
    if (run.asked_samples < 4.0) continue;
    const int samples = static_cast<int>(run.asked_samples);
    rules.push_back({std::to_string(samples) + " samples", with_samples(view, samples, false)});
    View by_error = with_samples(view, 16 * samples, true);
    by_error.render.rmse = run.error.rmse;
    rules.push_back({text("rmse %.4f", run.error.rmse), by_error});
    View by_time = with_samples(view, 16 * samples, true);
    by_time.render.time_ms = run.time_ms;
    rules.push_back({text("%.0f ms", run.time_ms), by_time});
  }
  return rules;
}

}  // namespace

std::vector<OracleRow> ask_oracle(const Studio& studio, const std::shared_ptr<const CompiledScene>& scene,
                                  const View& view, const Image& truth, const StudySeries& uniform) {
  std::vector<OracleRow> rows;
  for (const Rule& rule : rules_of(view, uniform)) {
    OracleRow row;
    row.rule = rule.name;
    row.predicted = predict_cost(scene, plan_view(*scene, rule.view), studio.pool());
    const auto drawings = studio.draw_rounds(scene, rule.view);
    StudyRun run;
    time_run(run, drawings);
    judge(run, drawings, truth, view.image.exposure, studio.pool());
    row.elapsed_ms = run.time_ms, row.rmse = run.error.rmse;
    row.is_time_inside =
        row.predicted.elapsed_low_ms <= row.elapsed_ms && row.elapsed_ms <= row.predicted.elapsed_high_ms;
    if (row.predicted.rmse >= 0.0)
      row.is_rmse_inside = row.predicted.rmse_low <= row.rmse && row.rmse <= row.predicted.rmse_high;
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace tilelight::study
