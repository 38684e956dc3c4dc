// SPDX-License-Identifier: Apache-2.0
#include "renderer/raster/lines/screen_grid.h"

#include <numeric>
#include <utility>

namespace tilelight::lines {
namespace {

constexpr double kWidenPx = 1e-3;  // far over the rounding of a projected point, far under a tile
constexpr int kLeastTilePx = 8;    // of the faces of a piece of chess at 720 lines most are smaller
constexpr int kMostTiles = 256;    // along an axis

}  // namespace

ScreenGrid::ScreenGrid(int width, int height, std::vector<ScreenBox> boxes) : boxes_(std::move(boxes)) {
  const Vec2 size(width, height);
  const int longest = std::max(width, height);
  double tile_px = std::max(kLeastTilePx, (longest + kMostTiles - 1) / kMostTiles);
  for (;; tile_px *= 2.0) {
    Level& level = levels_.emplace_back();
    level.tile_px = tile_px;
    level.columns = static_cast<int>((width - 1) / tile_px) + 1;
    level.rows = static_cast<int>((height - 1) / tile_px) + 1;
    if (level.columns <= 2 && level.rows <= 2) break;
  }
  std::vector<std::vector<uint32_t>> members(levels_.size());
  for (size_t i = 0; i < boxes_.size(); ++i) {
    ScreenBox& box = boxes_[i];
    if (box.is_empty()) continue;
    box.lo -= kWidenPx, box.hi += kWidenPx;
    if (!box.meets({Vec2(0.0), size})) continue;
    box.lo = glm::clamp(box.lo, Vec2(0.0), size), box.hi = glm::clamp(box.hi, Vec2(0.0), size);
    members[level_of(box)].push_back(static_cast<uint32_t>(i));
  }
  for (size_t i = 0; i < levels_.size(); ++i) fill(i, members[i]);
}

int ScreenGrid::level_of(const ScreenBox& box) const {
  const double longest = std::max(box.hi.x - box.lo.x, box.hi.y - box.lo.y);
  int level = 0;
  while (level + 1 < static_cast<int>(levels_.size()) && levels_[level].tile_px < longest) ++level;
  return level;
}

void ScreenGrid::fill(size_t at, const std::vector<uint32_t>& items) {
  Level& level = levels_[at];
  level.begins.assign(static_cast<size_t>(level.columns) * level.rows + 1, 0);
  const auto for_each_tile = [&](uint32_t item, auto act) {
    const ScreenBox& box = boxes_[item];
    const Range rows = level.tiles(box.lo.y, box.hi.y, level.rows);
    const Range columns = level.tiles(box.lo.x, box.hi.x, level.columns);
    for (int row = rows.first; row <= rows.last; ++row)
      for (int column = columns.first; column <= columns.last; ++column)
        act(static_cast<size_t>(row) * level.columns + column);
  };
  for (const uint32_t item : items) for_each_tile(item, [&](size_t tile) { ++level.begins[tile + 1]; });
  std::partial_sum(level.begins.begin(), level.begins.end(), level.begins.begin());
  level.items.resize(level.begins.back());
  std::vector<uint32_t> next(level.begins.begin(), level.begins.end() - 1);
  for (const uint32_t item : items) for_each_tile(item, [&](size_t tile) { level.items[next[tile]++] = item; });
}

ScreenGrid::Range ScreenGrid::Level::passed(const Vec2& from, const Vec2& to, int row) const {
  const double top = row * tile_px - kWidenPx, bottom = (row + 1) * tile_px + kWidenPx;
  double a = from.x, b = to.x;
  const double drop = to.y - from.y;
  if (drop != 0.0) {
    const auto x_at = [&](double y) { return from.x + std::clamp((y - from.y) / drop, 0.0, 1.0) * (to.x - from.x); };
    a = x_at(top), b = x_at(bottom);
  }
  return tiles(std::min(a, b) - kWidenPx, std::max(a, b) + kWidenPx, columns);
}

}  // namespace tilelight::lines
