// SPDX-License-Identifier: Apache-2.0
// Half spaces, and the parts of a segment that lie in them: what Roberts' test is made of. A segment's points are
// told by a parameter from 0 to 1. Pure; any thread.
#pragma once

#include <cmath>
#include <vector>

#include "renderer/base/vec.h"

namespace tilelight::lines {

// Where height <= 0.
struct HalfSpace {
  Vec3 normal{0.0};  // unit
  double offset = 0.0;
  double height(const Vec3& p) const { return glm::dot(normal, p) - offset; }
};

// An interval of the parameter.
struct Span {
  double from = 0.0, to = 1.0;
  bool is_empty() const { return !(from < to); }
};

// Exact at both ends.
inline Vec3 between(const Vec3& from, const Vec3& to, double t) { return (1.0 - t) * from + t * to; }

// A height that is rounding counts as none: the point lies in the plane.
inline double snapped(double height, double rounding) { return std::fabs(height) <= rounding ? 0.0 : height; }

// Whether a segment that lies in the bounding plane lies in the half space.
enum class Rim { in, out };

// Leaves of the span the part in a half space over which the segment's ends have these heights. The crossing is where
// the heights say, whatever was snapped at the other end.
inline void clip(Span& span, double height_from, double height_to, Rim rim) {
  if (height_from <= 0.0 && height_to <= 0.0) {
    if (rim == Rim::out && height_from == 0.0 && height_to == 0.0) span.to = span.from;
    return;
  }
  if (height_from >= 0.0 && height_to >= 0.0) {
    span.to = span.from;
    return;
  }
  const double crossing = height_from / (height_from - height_to);
  if (height_from > 0.0)
    span.from = std::fmax(span.from, crossing);
  else
    span.to = std::fmin(span.to, crossing);
}

// Sorts, and joins spans that meet or are no farther than `gap` apart. Empty ones vanish.
void unite(std::vector<Span>& spans, double gap);

// The parts of `whole` that no span of a united list covers, longer than `least`.
std::vector<Span> uncovered(const Span& whole, const std::vector<Span>& united, double least);

// The parts of `whole` in a united list, longer than `least`.
std::vector<Span> covered(const Span& whole, const std::vector<Span>& united, double least);

}  // namespace tilelight::lines
