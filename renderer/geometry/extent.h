// SPDX-License-Identifier: Apache-2.0
// Extent: the axis-aligned box around points of a mesh.
#pragma once

#include <limits>

#include "renderer/base/vec.h"

namespace tilelight {

struct Extent {
  Vec3 lo{std::numeric_limits<double>::infinity()}, hi{-std::numeric_limits<double>::infinity()};

  void grow(const Vec3& p) { lo = glm::min(lo, p), hi = glm::max(hi, p); }
  void grow(const Extent& other) { lo = glm::min(lo, other.lo), hi = glm::max(hi, other.hi); }
  Extent widened(double by) const { return {lo - by, hi + by}; }
  bool holds(const Extent& other) const {
    return glm::all(glm::lessThanEqual(lo, other.lo)) && glm::all(glm::greaterThanEqual(hi, other.hi));
  }
  bool meets(const Extent& other) const {
    return glm::all(glm::lessThanEqual(lo, other.hi)) && glm::all(glm::greaterThanEqual(hi, other.lo));
  }
};

}  // namespace tilelight
