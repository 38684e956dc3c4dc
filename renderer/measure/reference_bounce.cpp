// SPDX-License-Identifier: Apache-2.0
#include "renderer/measure/reference_bounce.h"

#include <cmath>

namespace tilelight::reference {
namespace {

Vec3 mirrored(const Vec3& d, const Vec3& n) { return glm::normalize(d - 2.0 * glm::dot(d, n) * n); }

Refraction bent(const Vec3& d, const Vec3& n, double ior_from, double ior_to) {
  const double eta = ior_from / ior_to;
  const double cos_from = -glm::dot(d, n);
  const double k = 1.0 - eta * eta * (1.0 - cos_from * cos_from);
  if (k < 0.0) return {};
  const double cos_to = std::sqrt(k);
  const double s = (ior_from * cos_from - ior_to * cos_to) / (ior_from * cos_from + ior_to * cos_to);
  const double p = (ior_from * cos_to - ior_to * cos_from) / (ior_from * cos_to + ior_to * cos_from);
  return {glm::normalize(eta * d + (eta * cos_from - cos_to) * n), 0.5 * (s * s + p * p)};
}

}  // namespace

Vec3 reflected(const Vec3& direction, const Vec3& geometric, const Vec3& shading) {
  const Vec3 r = mirrored(direction, shading);
  return glm::dot(geometric, r) > 0.0 ? r : mirrored(direction, geometric);
}

Refraction refracted(const Vec3& direction, const Vec3& geometric, const Vec3& shading, double ior_from,
                     double ior_to) {
  if (ior_from == ior_to) return {direction, 0.0};  // no interface: to the last bit straight on
  if (glm::dot(direction, shading) < 0.0) {
    const Refraction about_shading = bent(direction, shading, ior_from, ior_to);
    if (!about_shading.direction || glm::dot(*about_shading.direction, geometric) < 0.0) return about_shading;
  }
  return bent(direction, geometric, ior_from, ior_to);
}

}  // namespace tilelight::reference
