// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/facet.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tilelight {
namespace {

double largest_component(const Vec3& v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

}  // namespace

Vec3 unit_or_zero(const Vec3& v) {
  const double scale = largest_component(v);
  if (!(scale > 0.0) || !std::isfinite(scale)) return Vec3(0.0);
  const Vec3 s = v / scale;  // a length in [1, sqrt 3]: neither overflow nor underflow
  return s / std::sqrt(glm::dot(s, s));
}

Vec3 geometric_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, bc = c - b;
  const double longest = std::max({largest_component(ab), largest_component(ac), largest_component(bc)});
  if (!(longest > 0.0) || !std::isfinite(longest)) return Vec3(0.0);
  const Vec3 n = glm::cross(ab / longest, ac / longest);
  // |n| is the height over the longest side, in units of that side, up to a factor of 3.
  const double reach = std::max({largest_component(a), largest_component(b), largest_component(c)});
  constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon();
  if (!(largest_component(n) > kRounding * std::max(1.0, reach / longest))) return Vec3(0.0);
  return unit_or_zero(n);
}

}  // namespace tilelight
