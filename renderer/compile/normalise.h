// SPDX-License-Identifier: Apache-2.0
// Normalisation: subtract a centre, divide by a power of two. Scenes scaled by 2^k become the same bits, and a scene a
// million units from the origin loses nothing once it is rebased. Pure.
#pragma once

#include <cmath>

#include "renderer/compile/bvh.h"

namespace tilelight {

struct Normalisation {
  Vec3 center{0.0};
  double units = 1.0;  // user's units a normalised unit; a power of two

  Mat4 user_from_normalised() const {
    Mat4 m(1.0);
    for (int i = 0; i < 3; ++i) m[i][i] = units;
    m[3] = Vec4(center, 1.0);
    return m;
  }
  Mat4 normalised_from_user() const {
    Mat4 m(1.0);
    for (int i = 0; i < 3; ++i) m[i][i] = 1.0 / units;
    m[3] = Vec4(-center / units, 1.0);
    return m;
  }
};

// What reaches farthest from the centre lands in (0.5, 1]. A point gets units 1.
inline Normalisation normalise(const Box& box) {
  Normalisation n;
  if (box.is_empty()) return n;
  n.center = 0.5 * box.lo + 0.5 * box.hi;
  const Vec3 half = 0.5 * box.hi - 0.5 * box.lo;
  double longest = std::max({half.x, half.y, half.z});
  // Near its origin the user's space is finer than any other place of it can be: a box that lies there keeps the origin
  // as its centre, so that what is small there stays whole.
  if (std::max({std::abs(n.center.x), std::abs(n.center.y), std::abs(n.center.z)}) <= longest) {
    const Vec3 reach = glm::abs(n.center) + half;
    longest = std::max({reach.x, reach.y, reach.z});
    n.center = Vec3(0.0);
  }
  if (longest > 0.0) {
    int exponent = 0;
    const double fraction = std::frexp(longest, &exponent);
    n.units = std::ldexp(1.0, fraction == 0.5 ? exponent - 1 : exponent);
  }
  return n;
}

}  // namespace tilelight
