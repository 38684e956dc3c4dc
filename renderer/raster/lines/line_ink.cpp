// SPDX-License-Identifier: Apache-2.0
#include "renderer/raster/lines/line_ink.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tilelight {
namespace {

constexpr int kTilePx = 16;  // a few strokes each, in a drawing of chess at 720 lines

}  // namespace

LineInk::LineInk(const LineDrawing& drawing)
    : width_(drawing.width),
      height_(drawing.height),
      columns_((drawing.width + kTilePx - 1) / kTilePx),
      rows_((drawing.height + kTilePx - 1) / kTilePx),
      begins_(static_cast<size_t>(columns_) * rows_ + 1, 0) {
  const auto tile_range = [](double lo, double hi, int count) {
    const auto at = [&](double v) { return std::clamp(static_cast<int>(std::floor(v / kTilePx)), 0, count - 1); };
    return std::pair(at(lo), at(hi));
  };
  // act(tile) for each tile that the stroke meets, and few others.
  const auto for_each_tile = [&](const Stroke& s, auto act) {
    const Vec2 to = s.from + s.length * s.way, lo = glm::min(s.from, to), hi = glm::max(s.from, to);
    const auto [left, right] = tile_range(lo.x - s.half_width, hi.x + s.half_width, columns_);
    const auto [top, bottom] = tile_range(lo.y - s.half_width, hi.y + s.half_width, rows_);
    const double reach = s.half_width + 0.5 * kTilePx * (std::fabs(s.way.x) + std::fabs(s.way.y)) + 1e-6;
    for (int row = top; row <= bottom; ++row) {
      for (int column = left; column <= right; ++column) {
        const Vec2 off = double{kTilePx} * (Vec2(column, row) + 0.5) - s.from;
        if (std::fabs(off.x * s.way.y - off.y * s.way.x) <= reach) act(static_cast<size_t>(row) * columns_ + column);
      }
    }
  };
  std::vector<Stroke> strokes;
  for (const DrawnLine& line : drawing.lines) {
    const double length = glm::length(line.to - line.from);
    strokes.push_back({line.from, (line.to - line.from) / length, length,
                       0.5 * (line.is_hidden ? kHiddenLinePx : kVisibleLinePx), line.is_hidden ? line.along : -1.0});
  }
  for (const Stroke& s : strokes) for_each_tile(s, [&](size_t tile) { ++begins_[tile + 1]; });
  std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
  strokes_.resize(begins_.back());
  std::vector<uint32_t> next(begins_.begin(), begins_.end() - 1);
  for (const Stroke& s : strokes) for_each_tile(s, [&](size_t tile) { strokes_[next[tile]++] = s; });
}

bool LineInk::is_on(const Stroke& stroke, const Vec2& p) {
  const Vec2 off = p - stroke.from;
  const double at = glm::dot(off, stroke.way), aside = off.x * stroke.way.y - off.y * stroke.way.x;
  if (std::fabs(aside) > stroke.half_width) return false;
  if (stroke.along >= 0.0) {
    constexpr double kPeriod = kDashPx + kDashGapPx;
    const double dash = (stroke.along + at) / kPeriod;
    return at >= 0.0 && at <= stroke.length && (dash - std::floor(dash)) * kPeriod < kDashPx;
  }
  const double beyond = std::max({0.0, -at, at - stroke.length});
  return beyond * beyond + aside * aside <= stroke.half_width * stroke.half_width;
}

bool LineInk::is_inked(double x, double y) const {
  if (!(x >= 0.0 && x <= width_ && y >= 0.0 && y <= height_)) return false;
  const int column = std::min(static_cast<int>(x / kTilePx), columns_ - 1);
  const int row = std::min(static_cast<int>(y / kTilePx), rows_ - 1);
  const size_t tile = static_cast<size_t>(row) * columns_ + column;
  const auto first = strokes_.begin() + begins_[tile], last = strokes_.begin() + begins_[tile + 1];
  return std::any_of(first, last, [p = Vec2(x, y)](const Stroke& s) { return is_on(s, p); });
}

}  // namespace tilelight
