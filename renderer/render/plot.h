// SPDX-License-Identifier: Apache-2.0
// A plot of curves over two logarithmic axes, as SVG.
#pragma once

#include <string>
#include <vector>

namespace tilelight {

struct PlotPoint {
  double x = 0.0, y = 0.0;       // those that are not positive are left out
  double low = 0.0, high = 0.0;  // an interval of y; none where low is not positive
  bool is_marked = false;        // with a ring: on a front of the best
};

struct PlotCurve {
  std::string name;
  std::vector<PlotPoint> points;
};

struct Plot {
  std::string title, x_label, y_label;
  std::vector<PlotCurve> curves;
};

// A whole document. Names may hold any text: it is escaped.
std::string plot_svg(const Plot& plot);

}  // namespace tilelight
