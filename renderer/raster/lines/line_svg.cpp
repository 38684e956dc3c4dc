// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdio>

#include "renderer/raster/lines/line_drawing.h"

namespace tilelight {
namespace {

std::string number(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", v);
  std::string out = text;
  out.erase(out.find_last_not_of('0') + 1);
  if (out.back() == '.') out.pop_back();
  return out == "-0" ? "0" : out;
}

std::string point(const Vec2& p) { return number(p.x) + " " + number(p.y); }

// Drawn thousandths of a pixel apart is drawn in one place.
bool goes_on(const DrawnLine& line, const DrawnLine& before) {
  return line.along > 0.0 && glm::length(line.from - before.to) < 1e-3;
}

std::string path_data(const std::vector<DrawnLine>& lines, LineKind kind, bool is_hidden) {
  std::string data;
  const DrawnLine* before = nullptr;
  for (const DrawnLine& line : lines) {
    if (line.kind != kind || line.is_hidden != is_hidden) {
      before = nullptr;
      continue;
    }
    if (!before || !goes_on(line, *before)) data += (data.empty() ? "M" : "\nM") + point(line.from);
    data += "L" + point(line.to);
    before = &line;
  }
  return data;
}

}  // namespace

std::string line_drawing_svg(const LineDrawing& drawing) {
  constexpr std::array kKinds{std::pair(LineKind::silhouette, "silhouette"), std::pair(LineKind::crease, "crease"),
                              std::pair(LineKind::junction, "junction")};
  const std::string width = std::to_string(drawing.width), height = std::to_string(drawing.height);
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" + height +
                    "\" viewBox=\"0 0 " + width + " " + height + "\">\n<rect width=\"" + width + "\" height=\"" +
                    height + "\" fill=\"#fff\"/>\n<g fill=\"none\" stroke=\"#000\" stroke-linejoin=\"round\">\n";
  for (const bool is_hidden : {true, false}) {
    for (const auto& [kind, name] : kKinds) {
      const std::string data = path_data(drawing.lines, kind, is_hidden);
      if (data.empty()) continue;
      svg += std::string("<path class=\"") + name + (is_hidden ? " hidden" : "") + "\" stroke-width=\"" +
             number(is_hidden ? kHiddenLinePx : kVisibleLinePx) +
             (is_hidden ? "\" stroke-dasharray=\"" + number(kDashPx) + " " + number(kDashGapPx)
                        : std::string("\" stroke-linecap=\"round")) +
             "\" d=\"" + data + "\"/>\n";
    }
  }
  return svg + "</g>\n</svg>\n";
}

}  // namespace tilelight
