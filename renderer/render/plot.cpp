// SPDX-License-Identifier: Apache-2.0
#include "renderer/render/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "renderer/base/elementary.h"

namespace tilelight {
namespace {

constexpr double kWidth = 760.0, kHeight = 470.0;
constexpr double kLeft = 84.0, kRight = 24.0, kTop = 46.0, kBottom = 58.0;
constexpr int kMostListed = 16;  // curves in the legend

// Colours that people with any kind of colour vision can tell apart (Okabe and Ito 2008).
constexpr std::array<const char*, 7> kColors{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                             "#e69f00", "#56b4e9", "#000000"};
// When the colours come again, lines are dashed, then dotted.
constexpr std::array<const char*, 3> kDashes{"", " stroke-dasharray=\"7 3\"", " stroke-dasharray=\"2 3\""};

std::string color_of(size_t curve) { return kColors[curve % kColors.size()]; }
std::string stroke_of(size_t curve) {
  return " stroke=\"" + color_of(curve) + "\"" + kDashes[curve / kColors.size() % kDashes.size()];
}

double log10_of(double v) { return elementary::log2(v) / 3.321928094887362; }

std::string number(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", v);
  return text;
}

std::string tick_text(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0e", v);
  if (v >= 0.00099 && v < 99999.0) std::snprintf(text, sizeof text, "%g", v);
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

// A logarithmic axis, from value to place.
class Axis {
 public:
  Axis(double start_px, double end_px) : start_px_(start_px), end_px_(end_px) {}
  void take(double v) {
    if (!(v > 0.0) || !std::isfinite(v)) return;
    low_ = std::min(low_, log10_of(v));
    high_ = std::max(high_, log10_of(v));
  }
  // Some air at both ends; at least half a decade.
  void close() {
    if (low_ > high_) low_ = -1.0, high_ = 0.0;
    const double air = std::max(0.05 * (high_ - low_), 0.5 * (0.5 - (high_ - low_)));
    low_ -= air, high_ += air;
  }
  double at(double v) const { return start_px_ + (log10_of(v) - low_) / (high_ - low_) * (end_px_ - start_px_); }
  // 1, 2 and 5 of every decade; over many decades the 1 alone.
  std::vector<double> ticks() const {
    std::vector<double> out;
    for (int decade = static_cast<int>(std::floor(low_)); decade <= high_; ++decade) {
      for (const double digit : {1.0, 2.0, 5.0}) {
        if (digit != 1.0 && high_ - low_ > 3.0) continue;
        const double at = decade + log10_of(digit);
        if (at < low_ || at > high_) continue;
        double power = digit;
        for (int i = 0; i < std::abs(decade); ++i) decade < 0 ? power /= 10.0 : power *= 10.0;
        out.push_back(power);
      }
    }
    return out;
  }

 private:
  double start_px_, end_px_;
  double low_ = 1e9, high_ = -1e9;
};

std::string text_at(double x, double y, const std::string& text, const std::string& attributes) {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" " + attributes + ">" + escaped(text) + "</text>\n";
}

std::string line(double x1, double y1, double x2, double y2, const char* stroke) {
  return "<line x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" + number(x2) + "\" y2=\"" + number(y2) +
         "\" stroke=\"" + stroke + "\"/>\n";
}

bool is_shown(const PlotPoint& p) { return p.x > 0.0 && p.y > 0.0 && std::isfinite(p.x) && std::isfinite(p.y); }

std::string draw_curve(const PlotCurve& curve, const Axis& x, const Axis& y, size_t index) {
  const std::string color = color_of(index);
  std::string path, upper, lower, marks;
  for (const PlotPoint& p : curve.points) {
    if (!is_shown(p)) continue;
    const std::string at = number(x.at(p.x)) + "," + number(y.at(p.y));
    path += (path.empty() ? "M" : " L") + at;
    if (p.low > 0.0) {
      upper += (upper.empty() ? "M" : " L") + number(x.at(p.x)) + "," + number(y.at(p.high));
      lower = " L" + number(x.at(p.x)) + "," + number(y.at(p.low)) + lower;
    }
    marks +=
        "<circle cx=\"" + number(x.at(p.x)) + "\" cy=\"" + number(y.at(p.y)) + "\" r=\"3\" fill=\"" + color + "\"/>\n";
    if (p.is_marked)
      marks += "<circle cx=\"" + number(x.at(p.x)) + "\" cy=\"" + number(y.at(p.y)) +
               "\" r=\"6\" fill=\"none\" stroke=\"" + color + "\"/>\n";
  }
  std::string out;
  if (!upper.empty()) out += "<path d=\"" + upper + lower + " Z\" fill=\"" + color + "\" opacity=\"0.15\"/>\n";
  out += "<path d=\"" + path + "\" fill=\"none\"" + stroke_of(index) + " stroke-width=\"1.8\"/>\n";
  return out + marks;
}

}  // namespace

std::string plot_svg(const Plot& plot) {
  const double legend = plot.curves.size() > 1 ? 14.0 * std::min<double>(kMostListed, plot.curves.size()) : 0.0;
  Axis x(kLeft, kWidth - kRight), y(kHeight - kBottom, kTop);
  for (const PlotCurve& curve : plot.curves) {
    for (const PlotPoint& p : curve.points) {
      if (!is_shown(p)) continue;
      x.take(p.x), y.take(p.y), y.take(p.low), y.take(p.high);
    }
  }
  x.close(), y.close();

  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number(kWidth) + " " +
                    number(kHeight + legend) + "\" width=\"" + number(kWidth) + "\" height=\"" +
                    number(kHeight + legend) +
                    "\" font-family=\"system-ui, sans-serif\" font-size=\"12\" role=\"img\">\n";
  out += "<title>" + escaped(plot.title) + "</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  out += text_at(kLeft, 26.0, plot.title, "font-size=\"15\" font-weight=\"600\"");
  for (const double tick : x.ticks()) {
    out += line(x.at(tick), kTop, x.at(tick), kHeight - kBottom, "#e2e2e2");
    out += text_at(x.at(tick), kHeight - kBottom + 18.0, tick_text(tick), "text-anchor=\"middle\" fill=\"#444444\"");
  }
  for (const double tick : y.ticks()) {
    out += line(kLeft, y.at(tick), kWidth - kRight, y.at(tick), "#e2e2e2");
    out += text_at(kLeft - 8.0, y.at(tick) + 4.0, tick_text(tick), "text-anchor=\"end\" fill=\"#444444\"");
  }
  out += line(kLeft, kTop, kLeft, kHeight - kBottom, "#444444");
  out += line(kLeft, kHeight - kBottom, kWidth - kRight, kHeight - kBottom, "#444444");
  out += text_at(0.5 * (kLeft + kWidth - kRight), kHeight - 16.0, plot.x_label, "text-anchor=\"middle\"");
  const double middle = 0.5 * (kTop + kHeight - kBottom);
  out +=
      text_at(20.0, middle, plot.y_label, "text-anchor=\"middle\" transform=\"rotate(-90 20 " + number(middle) + ")\"");
  for (size_t i = 0; i < plot.curves.size(); ++i) out += draw_curve(plot.curves[i], x, y, i);
  for (size_t i = 0; i < std::min<size_t>(kMostListed, plot.curves.size()) && legend > 0.0; ++i) {
    const double at = kHeight + 14.0 * static_cast<double>(i);
    out += "<path d=\"M" + number(kLeft) + "," + number(at - 7.0) + " h18\" fill=\"none\"" + stroke_of(i) +
           " stroke-width=\"4\"/>\n";
    out += text_at(kLeft + 26.0, at - 3.0, plot.curves[i].name, "fill=\"#222222\"");
  }
  return out + "</svg>\n";
}

}  // namespace tilelight
