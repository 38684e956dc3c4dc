// SPDX-License-Identifier: Apache-2.0
#include "renderer/render/plot.h"
#include "renderer/render/render.h"

namespace tilelight {

std::string report_svg(const RenderReport& report) {
  PlotCurve curve{"", {}};
  for (const ReportPoint& p : report.points) {
    if (p.error.is_known) curve.points.push_back({p.elapsed_ms, p.error.rmse, p.error.low, p.error.high});
  }
  return plot_svg({"Error against run time", "time, ms", "rmse of displayed - true, with 95 % interval", {curve}});
}

}  // namespace tilelight
