// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>

#include "renderer/study/study.h"

namespace tilelight {
namespace {

// As RFC 4180 quotes it.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

// Empty where it is not finite: of equal pictures.
std::string number(double v) {
  if (!std::isfinite(v)) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", v);
  return text;
}

}  // namespace

std::string study_csv(const Study& study) {
  std::string out =
      "series,method,shading,sampling,precision,setting,spp,time_ms,time_low_ms,time_high_ms,cpu_ms,rmse,rmse_low,"
      "rmse_high,p99,max,rel_mse,psnr_db,ssim,flip,told_rmse,told_rounds,told_inside,efficiency,pareto\r\n";
  for (const StudySeries& series : study.series) {
    for (const StudyRun& run : series.runs) {
      for (const std::string& word : {series.name, series.method, series.shading, series.sampling, series.precision})
        out += quoted(word) + ",";
      out += quoted(run.setting);
      const ImageError& e = run.error;
      for (const double v : {run.spp, run.time_ms, run.time_low_ms, run.time_high_ms, run.cpu_ms, e.rmse, run.rmse_low,
                             run.rmse_high, e.p99, e.most, e.rel_mse, e.psnr_db, e.ssim, e.flip})
        out += "," + number(v);
      out += "," + (run.told_rmse < 0.0 ? std::string() : number(run.told_rmse)) + "," +
             std::to_string(run.told_rounds) + "," + std::to_string(run.told_inside) + "," + number(run.efficiency) +
             (run.is_on_front ? ",true" : ",false") + "\r\n";
    }
  }
  return out;
}

}  // namespace tilelight
