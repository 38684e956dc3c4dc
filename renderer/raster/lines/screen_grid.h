// SPDX-License-Identifier: Apache-2.0
// ScreenGrid: finds the boxes in the image that a segment may meet. A pyramid of grids of square tiles: each box lies
// in the level where it spans at most two tiles along each axis, so that memory is bounded by the number of boxes.
// Pixels. Immutable after construction; any thread may read.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/base/vec.h"

namespace tilelight::lines {

struct ScreenBox {
  Vec2 lo{1.0}, hi{0.0};  // empty
  void grow(const Vec2& p) {
    if (is_empty())
      lo = hi = p;
    else
      lo = glm::min(lo, p), hi = glm::max(hi, p);
  }
  bool is_empty() const { return lo.x > hi.x; }
  bool meets(const ScreenBox& b) const { return lo.x <= b.hi.x && b.lo.x <= hi.x && lo.y <= b.hi.y && b.lo.y <= hi.y; }
};

class ScreenGrid {
 public:
  // Boxes are widened a little for rounding and cut at the image's border. Empty ones are never met.
  ScreenGrid(int width, int height, std::vector<ScreenBox> boxes);

  // Calls visit(index) once for every box that meets the segment's own box and whose tiles the segment passes, large
  // boxes first, in an order that depends on boxes and segment alone. Stops where visit returns true. REQUIRES: the
  // segment lies in the image.
  template <class Visit>
  void visit(const Vec2& from, const Vec2& to, Visit visit) const;

 private:
  struct Range {
    int first, last;
  };
  struct Level {
    double tile_px = 0.0;
    int columns = 0, rows = 0;
    std::vector<uint32_t> begins, items;  // of tiles, row by row
    Range tiles(double lo, double hi, int count) const {
      const auto at = [&](double v) { return std::clamp(static_cast<int>(v / tile_px), 0, count - 1); };
      return {at(lo), at(hi)};
    }
    // The tiles of a row that the segment passes.
    Range passed(const Vec2& from, const Vec2& to, int row) const;
  };
  int level_of(const ScreenBox& box) const;
  void fill(size_t level, const std::vector<uint32_t>& items);

  std::vector<ScreenBox> boxes_;
  std::vector<Level> levels_;
};

template <class Visit>
void ScreenGrid::visit(const Vec2& from, const Vec2& to, Visit visit) const {
  const ScreenBox own{glm::min(from, to), glm::max(from, to)};
  for (auto at = levels_.rbegin(); at != levels_.rend(); ++at) {
    const Level& level = *at;
    if (level.items.empty()) continue;
    const Range rows = level.tiles(own.lo.y, own.hi.y, level.rows);
    Range above{0, -1};  // the tiles passed in the row above
    for (int row = rows.first; row <= rows.last; ++row) {
      const Range passed = level.passed(from, to, row);
      for (int column = passed.first; column <= passed.last; ++column) {
        const size_t tile = static_cast<size_t>(row) * level.columns + column;
        for (uint32_t i = level.begins[tile]; i < level.begins[tile + 1]; ++i) {
          const ScreenBox& box = boxes_[level.items[i]];
          if (!box.meets(own)) continue;
          // A box may lie in up to four tiles; it is met in the first of them that the segment passes.
          const Range columns = level.tiles(box.lo.x, box.hi.x, level.columns);
          if (column != std::max(columns.first, passed.first)) continue;
          const bool was_above = level.tiles(box.lo.y, box.hi.y, level.rows).first < row &&
                                 above.first <= columns.last && columns.first <= above.last;
          if (!was_above && visit(level.items[i])) return;
        }
      }
      above = passed;
    }
  }
}

}  // namespace tilelight::lines
