// SPDX-License-Identifier: Apache-2.0
#include "renderer/raster/lines/chains.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

namespace tilelight::lines {
namespace {

// Ends of lines of one body and kind, seen or hidden, in one place of the image.
using Place = std::tuple<bool, LineKind, uint32_t, uint32_t, int64_t, int64_t>;

Place place_of(const DrawnLine& line, const Vec2& end) {
  constexpr double kPlacesAPixel = 1e4;
  const auto whole = [](double v) { return static_cast<int64_t>(std::floor(v * kPlacesAPixel + 0.5)); };
  return {line.is_hidden, line.kind, line.body, line.other, whole(end.x), whole(end.y)};
}

class Chains {
 public:
  explicit Chains(const std::vector<DrawnLine>& lines) : lines_(lines), is_taken_(lines.size(), false) {
    for (uint32_t i = 0; i < lines.size(); ++i) {
      ends_.emplace_back(place_of(lines[i], lines[i].from), i);
      ends_.emplace_back(place_of(lines[i], lines[i].to), i);
    }
    std::sort(ends_.begin(), ends_.end());
  }

  std::vector<DrawnLine> make() {
    for (const bool takes_rings : {false, true}) {
      for (uint32_t i = 0; i < lines_.size(); ++i) {
        if (is_taken_[i]) continue;
        const bool starts = !next(i, lines_[i].from), ends = !next(i, lines_[i].to);
        if (starts || takes_rings)
          walk(i, false);
        else if (ends)
          walk(i, true);
      }
    }
    return std::move(out_);
  }

 private:
  // The one other line that goes on from an end.
  const uint32_t* next(uint32_t line, const Vec2& end) const {
    const Place place = place_of(lines_[line], end);
    const auto first = std::lower_bound(ends_.begin(), ends_.end(), std::pair(place, uint32_t{0}));
    const auto last = std::find_if(first, ends_.end(), [&](const auto& e) { return e.first != place; });
    if (last - first != 2 || first[0].second == first[1].second) return nullptr;
    return first[0].second == line ? &first[1].second : &first[0].second;
  }

  void walk(uint32_t line, bool is_turned) {
    double along = 0.0;
    for (;;) {
      is_taken_[line] = true;
      DrawnLine& drawn = out_.emplace_back(lines_[line]);
      if (is_turned) std::swap(drawn.from, drawn.to);
      drawn.along = along;
      along += glm::length(drawn.to - drawn.from);
      const uint32_t* const on = next(line, drawn.to);
      if (!on || is_taken_[*on]) return;
      is_turned = place_of(lines_[*on], lines_[*on].from) != place_of(drawn, drawn.to);
      line = *on;
    }
  }

  const std::vector<DrawnLine>& lines_;
  std::vector<bool> is_taken_;
  std::vector<std::pair<Place, uint32_t>> ends_;
  std::vector<DrawnLine> out_;
};

}  // namespace

std::vector<DrawnLine> in_chains(const std::vector<DrawnLine>& lines) { return Chains(lines).make(); }

}  // namespace tilelight::lines
