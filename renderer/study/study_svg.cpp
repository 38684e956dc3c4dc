// SPDX-License-Identifier: Apache-2.0
#include "renderer/render/plot.h"
#include "renderer/study/study.h"

namespace tilelight {

std::string study_svg(const Study& study) {
  Plot plot{"Error against run time: " + study.scene_name,
            "time of drawing, ms (median)",
            "rmse of displayed - true, with its spread over rounds",
            {}};
  for (const StudySeries& series : study.series) {
    PlotCurve& curve = plot.curves.emplace_back(PlotCurve{series.name, {}});
    for (const StudyRun& run : series.runs)
      curve.points.push_back({run.time_ms, run.error.rmse, run.rmse_low, run.rmse_high, run.is_on_front});
  }
  return plot_svg(plot);
}

}  // namespace tilelight
