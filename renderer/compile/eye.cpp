// SPDX-License-Identifier: Apache-2.0
#include "renderer/compile/eye.h"

#include <cmath>

#include "renderer/base/elementary.h"
#include "renderer/base/safe_length.h"
#include "renderer/scene/camera_up.h"

namespace tilelight {
Eye make_eye(const Camera& camera, int width, int height, const Vec3& center, double units) {
  Eye eye;
  eye.projection = camera.projection;
  eye.origin = (camera.position - center) / units;
  eye.forward = safe_normalize(camera.target - camera.position);
  const Vec3 right = safe_normalize(glm::cross(eye.forward, usable_up(camera)));
  const Vec3 up = glm::cross(right, eye.forward);

  const bool is_perspective = camera.projection == Projection::perspective;
  const double half_height =
      is_perspective ? elementary::tan(elementary::rad_from_deg(0.5 * camera.fov_y_deg)) : 0.5 * camera.height / units;
  const double px = 2.0 * half_height / height;  // edge of a pixel on the image plane
  eye.step_x = right * px;
  eye.step_y = up * -px;
  eye.corner = up * half_height - right * (0.5 * width * px);
  eye.start = eye.origin;
  eye.lead = is_perspective ? 0.0 : 1.0;
  return eye;
}

void start_near_bodies(Eye& eye, const Vec3& target, int width, int height, std::span<const Vec4> planes) {
  constexpr double kFar = 0x1p10;  // nearer than this the rounding of a start is under 2^-43 of the bodies
  constexpr double kReach = 2.0;   // no body is farther from the centre
  if (!(safe_length(eye.origin) > kFar) || !(glm::dot(-eye.origin, eye.forward) > kReach)) return;
  const Vec3& known = safe_length(target) < safe_length(eye.origin) ? target : eye.origin;
  Eye near = eye;
  near.start = known + (-glm::dot(known, eye.forward) - kReach) * eye.forward;
  if (eye.projection == Projection::perspective) near.lead = glm::dot(near.start - eye.origin, eye.forward);
  // A plane that lies between the rays' old and new starts has them on two sides somewhere at the picture's corners.
  for (const Vec4& plane : planes) {
    const auto is_above = [&](const Vec3& p) { return glm::dot(Vec3(plane), p) + plane.w > 0.0; };
    for (int corner = 0; corner < 4; ++corner) {
      const double x = corner & 1 ? width : 0.0, y = corner & 2 ? height : 0.0;
      if (is_above(eye_ray(eye, x, y).origin) != is_above(eye_ray(near, x, y).origin)) return;
    }
  }
  eye = near;
}

}  // namespace tilelight
