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

// glm::normalize, of vectors of any length but 0; for the many of ordinary length it costs no more.
inline Vec3 unit_of(const Vec3& v) {
  const double square = glm::dot(v, v);
  return square > 1e-200 && square < 1e200 ? glm::normalize(v) : safe_normalize(v);
}

// A vector along a x b, for edges of any length; glm::cross where that keeps its digits.
inline Vec3 cross_of(const Vec3& a, const Vec3& b) {
  const Vec3 n = glm::cross(a, b);
  return glm::dot(n, n) > 1e-200 ? n : glm::cross(scale_to_one(a).v, scale_to_one(b).v);
}

}  // namespace tilelight
