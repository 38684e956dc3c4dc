// SPDX-License-Identifier: Apache-2.0
#include "renderer/scene/camera_up.h"

#include "renderer/base/safe_length.h"

namespace tilelight {
namespace {

Vec3 forward_of(const Camera& camera) { return safe_normalize(camera.target - camera.position); }

// Both of unit length.
bool is_along(const Vec3& a, const Vec3& b) { return !(glm::length(glm::cross(a, b)) > kUpAlongViewSine); }

}  // namespace

bool is_up_along_view(const Camera& camera) { return is_along(forward_of(camera), safe_normalize(camera.up)); }

Vec3 usable_up(const Camera& camera) {
  const Vec3 world_up(0.0, 1.0, 0.0);
  if (!is_up_along_view(camera)) return safe_normalize(camera.up);
  const Vec3 forward = forward_of(camera);
  if (!is_along(forward, world_up)) return world_up;
  return {0.0, 0.0, forward.y < 0.0 ? -1.0 : 1.0};
}

}  // namespace tilelight
