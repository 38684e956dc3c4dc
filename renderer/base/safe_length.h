// SPDX-License-Identifier: Apache-2.0
// Lengths of vectors whose squares leave the range of a double. The vector is scaled by a power of two first, so that
// ordinary vectors give the bits of glm's functions. Pure; any thread.
#pragma once

#include <algorithm>
#include <cmath>

#include "renderer/base/vec.h"

namespace tilelight {

struct ScaledVec {
  Vec3 v;        // the largest component in [0.5, 1); 0 where the vector was
  int exponent;  // the vector is v * 2^exponent
};
inline ScaledVec scale_to_one(const Vec3& v) {
  int exponent = 0;
  std::frexp(std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}), &exponent);
  return {{std::ldexp(v.x, -exponent), std::ldexp(v.y, -exponent), std::ldexp(v.z, -exponent)}, exponent};
}

inline double safe_length(const Vec3& v) {
  const ScaledVec scaled = scale_to_one(v);
  return std::ldexp(glm::length(scaled.v), scaled.exponent);
}

// REQUIRES: v is not zero.
inline Vec3 safe_normalize(const Vec3& v) { return glm::normalize(scale_to_one(v).v); }

}  // namespace tilelight
