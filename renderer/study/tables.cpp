// SPDX-License-Identifier: Apache-2.0
#include "renderer/study/tables.h"

#include <algorithm>

namespace tilelight::study {
namespace {

std::vector<std::vector<Sample>> curves_of(const Study& study, bool by_time) {
  std::vector<std::vector<Sample>> curves;
  for (const StudySeries& series : study.series) {
    std::vector<Sample>& curve = curves.emplace_back();
    for (const StudyRun& run : series.runs)
      curve.push_back(by_time ? Sample{run.time_ms, run.error.rmse} : Sample{run.error.rmse, run.time_ms});
    std::sort(curve.begin(), curve.end(), [](const Sample& a, const Sample& b) { return a.x < b.x; });
  }
  return curves;
}

// Rows in which at least one series has a value.
std::vector<TableRow> rows_at(const std::vector<double>& places, const std::vector<std::vector<Sample>>& curves) {
  std::vector<TableRow> rows;
  for (const double at : places) {
    TableRow row{at, {}};
    for (const auto& curve : curves) row.values.push_back(on_curve(curve, at));
    if (std::any_of(row.values.begin(), row.values.end(), [](const auto& v) { return v.has_value(); }))
      rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

std::vector<TableRow> equal_time(const Study& study) {
  std::vector<double> times;
  for (const StudyRun& run : study.series.front().runs) times.push_back(run.time_ms);
  return rows_at(times, curves_of(study, true));
}

std::vector<TableRow> equal_error(const Study& study) {
  return rows_at({0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001, 0.0005}, curves_of(study, false));
}

}  // namespace tilelight::study
