// SPDX-License-Identifier: Apache-2.0
#include "renderer/raster/projection.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tilelight {
namespace {

Vec3 place_of(const ImagePoint& p) { return {p.w, p.x, p.y}; }

// What rounding may have done to an affine function with terms of this size.
double slack_of(const Affine& f, double width, double height, double magnified) {
  constexpr double kRounding = 0x1p-48;  // some sixteen roundings
  return kRounding * magnified * (std::abs(f.at[0]) + std::abs(f.at[1]) * width + std::abs(f.at[2]) * height);
}

}  // namespace

double ImageProjection::least_nearness() const {
  if (is_inverse()) return 0.0;
  return is_perspective() ? -1.0 : -std::numeric_limits<double>::infinity();
}

double ImageProjection::most_nearness() const { return is_inverse() ? std::numeric_limits<double>::infinity() : 0.0; }

// A ray from start + lead * a along forward + a, where a = corner + x * step_x + y * step_y, meets the plane at
// (d - lead * n.a) / (n.forward + n.a) of its depth from the start, d = n.(place - start). At that depth w is
// (d + lead * n.forward) / (n.forward + n.a).
Affine ImageProjection::nearness_of_plane(const Vec3& place, const Vec3& normal) const {
  const double d = glm::dot(normal, place - eye_.start), ahead = glm::dot(normal, eye_.forward);
  const double across[3] = {glm::dot(normal, eye_.corner), glm::dot(normal, eye_.step_x),
                            glm::dot(normal, eye_.step_y)};
  Affine out;
  for (int i = 0; i < 3; ++i) {
    const double constant = i == 0 ? 1.0 : 0.0;
    if (is_inverse()) {
      out.at[i] = (constant * ahead + across[i]) / d;
    } else {
      const double w = is_perspective() ? d + eye_.lead * ahead : ahead;
      out.at[i] = (eye_.lead * across[i] - constant * d) / w;
    }
  }
  return out;
}

// Cramer's rule about the first place, so that what the three have in common cancels before it is rounded.
bool nearness_through(const ImagePoint& a, const ImagePoint& b, const ImagePoint& c, double width, double height,
                      Affine& out, double& slack) {
  const Vec3 p = place_of(a), u = place_of(b) - p, v = place_of(c) - p;
  const Vec3 normal = glm::cross(u, v);
  const double determinant = glm::dot(p, normal);
  const Vec3 sum =
      a.nearness * normal + (b.nearness - a.nearness) * glm::cross(v, p) + (c.nearness - a.nearness) * glm::cross(p, u);
  for (int i = 0; i < 3; ++i) out.at[i] = sum[i] / determinant;
  const double size = std::abs(p.x * normal.x) + std::abs(p.y * normal.y) + std::abs(p.z * normal.z);
  slack = slack_of(out, width, height, size / std::abs(determinant));
  return determinant != 0.0 && std::isfinite(slack);
}

}  // namespace tilelight
