// SPDX-License-Identifier: Apache-2.0
#include "renderer/measure/reference_bounce.h"

#include <algorithm>
#include <cmath>

#include "renderer/base/elementary.h"

namespace tilelight::reference {
namespace {

Vec3 mirrored(const Vec3& d, const Vec3& n) { return glm::normalize(d - 2.0 * glm::dot(d, n) * n); }

constexpr double kRightAngle = 1.5707963267948966;

double angle_of_sine(double sine) { return kRightAngle - elementary::acos(sine); }

// Fresnel's reflectance from the cosines on both sides.
double reflectance(double cos_from, double cos_to, double ior_from, double ior_to) {
  const double s = (ior_from * cos_from - ior_to * cos_to) / (ior_from * cos_from + ior_to * cos_to);
  const double p = (ior_from * cos_to - ior_to * cos_from) / (ior_from * cos_to + ior_to * cos_from);
  return 0.5 * (s * s + p * p);
}

// The direction that makes an angle with -n, in the plane of d and n.
Vec3 turned_to(const Vec3& d, const Vec3& n, double angle) {
  const Vec3 along = glm::normalize(d - glm::dot(d, n) * n);
  return elementary::sin(angle) * along - elementary::cos(angle) * n;
}

}  // namespace

Vec3 reflected(const Vec3& direction, const Vec3& geometric, const Vec3& shading) {
  const Vec3 r = mirrored(direction, shading);
  return glm::dot(geometric, r) > 0.0 ? r : mirrored(direction, geometric);
}

Refraction refracted(const Vec3& direction, const Vec3& geometric, const Vec3& shading, double spread, double ior_from,
                     double ior_to) {
  if (ior_from == ior_to) return {direction, 0.0};  // no interface: to the last bit straight on
  const double cos_from = std::max(0.0, -glm::dot(direction, shading));
  const double sin_from = std::sqrt(std::max(0.0, 1.0 - cos_from * cos_from));
  const double sin_to = ior_from / ior_to * sin_from;
  Refraction out;
  if (sin_to < 1.0) {
    const double cos_to = std::sqrt(1.0 - sin_to * sin_to);
    const double eta = ior_from / ior_to;
    out.direction = cos_from > 0.0 ? glm::normalize(eta * direction + (eta * cos_from - cos_to) * shading)
                                   : turned_to(direction, shading, angle_of_sine(sin_to));
    out.fresnel = reflectance(cos_from, cos_to, ior_from, ior_to);
  } else {
    const double critical = angle_of_sine(ior_to / ior_from);
    if (spread == 0.0 || elementary::acos(cos_from) >= critical + spread) return {};
    out.direction = turned_to(direction, shading, kRightAngle - spread);
    const double back = angle_of_sine(ior_to / ior_from * elementary::cos(spread));
    out.fresnel = reflectance(elementary::cos(back), elementary::sin(spread), ior_from, ior_to);
  }
  const double above = glm::dot(*out.direction, geometric);
  if (above > 0.0) *out.direction -= 2.0 * above * geometric;
  return out;
}

}  // namespace tilelight::reference
