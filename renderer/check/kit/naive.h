// SPDX-License-Identifier: Apache-2.0
// Intersections as textbooks print them, in float and with fixed epsilons. They serve the catalogue alone: each of them
// fails somewhere, and there ours has to hold.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/glm.hpp>

namespace tilelight::check {

using Vec3f = glm::vec3;

namespace naive {

struct RayF {
  Vec3f origin{0.0f}, direction{0.0f};
};

// The quadratic with b^2 - 4ac, the smaller root that lies beyond t_min.
inline std::optional<float> sphere(const RayF& ray, const Vec3f& center, float radius, float t_min) {
  const Vec3f oc = ray.origin - center;
  const float a = glm::dot(ray.direction, ray.direction);
  const float b = 2.0f * glm::dot(oc, ray.direction);
  const float c = glm::dot(oc, oc) - radius * radius;
  const float discriminant = b * b - 4.0f * a * c;
  if (discriminant < 0.0f) return std::nullopt;
  const float root = std::sqrt(discriminant);
  for (const float t : {(-b - root) / (2.0f * a), (-b + root) / (2.0f * a)})
    if (t > t_min) return t;
  return std::nullopt;
}

// The smaller root, whatever its sign.
inline std::optional<float> smaller_root(const RayF& ray, const Vec3f& center, float radius) {
  return sphere(ray, center, radius, -std::numeric_limits<float>::infinity());
}

struct Slabs {
  float near, far;
};
// Kay and Kajiya's slabs with min and max alone: 0 * inf on a face plane is NaN, and what NaN compares to decides.
// touching: whether a ray that meets the box in one point, near = far, hits it.
inline std::optional<Slabs> slabs(const RayF& ray, const Vec3f& lower, const Vec3f& upper, bool touching) {
  const Vec3f inverse = 1.0f / ray.direction;
  const Vec3f t0 = (lower - ray.origin) * inverse, t1 = (upper - ray.origin) * inverse;
  const float near = std::max({std::min(t0.x, t1.x), std::min(t0.y, t1.y), std::min(t0.z, t1.z)});
  const float far = std::min({std::max(t0.x, t1.x), std::max(t0.y, t1.y), std::max(t0.z, t1.z)});
  if (!(touching ? near <= far : near < far) || far < 0.0f) return std::nullopt;
  return Slabs{near, far};
}

struct TriangleHit {
  float t, u, v;
};
// Moeller and Trumbore 1997; epsilon: of the determinant, as in the paper's listing.
inline std::optional<TriangleHit> triangle(const RayF& ray, const Vec3f& a, const Vec3f& b, const Vec3f& c, float t_min,
                                           float epsilon = 1e-6f) {
  const Vec3f e1 = b - a, e2 = c - a, p = glm::cross(ray.direction, e2);
  const float det = glm::dot(e1, p);
  if (det > -epsilon && det < epsilon) return std::nullopt;
  const float inverse = 1.0f / det;
  const Vec3f s = ray.origin - a;
  const float u = glm::dot(s, p) * inverse;
  if (u < 0.0f || u > 1.0f) return std::nullopt;
  const Vec3f q = glm::cross(s, e1);
  const float v = glm::dot(ray.direction, q) * inverse;
  if (v < 0.0f || u + v > 1.0f) return std::nullopt;
  const float t = glm::dot(e2, q) * inverse;
  if (!(t > t_min)) return std::nullopt;
  return TriangleHit{t, u, v};
}

}  // namespace naive
}  // namespace tilelight::check
