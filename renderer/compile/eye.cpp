// SPDX-License-Identifier: Apache-2.0
#include "renderer/compile/eye.h"

#include <algorithm>
#include <cmath>

#include "renderer/base/elementary.h"

namespace tilelight {
namespace {

// Scaled by the largest component first: eye and target may be 1e-30 or 1e+30 apart.
Vec3 safe_normalize(const Vec3& v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  return glm::normalize(v / largest);
}

Vec3 least_aligned_axis(const Vec3& forward) {
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(forward[i]) < std::abs(forward[axis])) axis = i;
  }
  Vec3 up(0.0);
  up[axis] = 1.0;
  return up;
}

}  // namespace

bool is_up_along_view(const Camera& camera) {
  const Vec3 forward = safe_normalize(camera.target - camera.position);
  return !(glm::length(glm::cross(forward, safe_normalize(camera.up))) > kUpAlongViewSine);
}

Eye make_eye(const Camera& camera, int width, int height, const Vec3& center, double units) {
  Eye eye;
  eye.projection = camera.projection;
  eye.origin = (camera.position - center) / units;
  eye.forward = safe_normalize(camera.target - camera.position);
  const Vec3 up_hint = is_up_along_view(camera) ? least_aligned_axis(eye.forward) : safe_normalize(camera.up);
  const Vec3 right = safe_normalize(glm::cross(eye.forward, up_hint));
  const Vec3 up = glm::cross(right, eye.forward);

  const bool is_perspective = camera.projection == Projection::perspective;
  const double half_height =
      is_perspective ? elementary::tan(elementary::rad_from_deg(0.5 * camera.fov_y_deg)) : 0.5 * camera.height / units;
  const double px = 2.0 * half_height / height;  // edge of a pixel on the image plane
  eye.step_x = right * px;
  eye.step_y = up * -px;
  eye.corner = up * half_height - right * (0.5 * width * px);
  if (is_perspective) eye.corner += eye.forward;
  return eye;
}

}  // namespace tilelight
