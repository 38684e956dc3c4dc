// SPDX-License-Identifier: Apache-2.0
// Eye: a camera made ready to shoot primary rays, in the scene's normalised space, double. Plain value; any thread.
#pragma once

#include <span>

#include "renderer/base/vec.h"
#include "renderer/scene/scene.h"

namespace tilelight {

struct Eye {
  Projection projection = Projection::perspective;
  Vec3 origin{0.0};              // the eye
  Vec3 forward{0.0, 0.0, -1.0};  // unit
  // The image plane: a point (x, y) of the image, in pixels from its top left corner, lies
  // corner + x * step_x + y * step_y off the axis; for a perspective eye at distance 1.
  Vec3 corner{0.0}, step_x{0.0}, step_y{0.0};
  // Rays start around this point of the axis, `lead` times as far off it as on the image plane. A perspective eye's
  // start in the eye itself unless it is far away.
  Vec3 start{0.0};
  double lead = 0.0;
};

struct EyeRay {
  Vec3 origin, direction;  // unit
};
// The ray through a point of the image.
inline EyeRay eye_ray(const Eye& eye, double x, double y) {
  const Vec3 across = eye.corner + x * eye.step_x + y * eye.step_y;
  const Vec3 origin = eye.start + eye.lead * across;
  if (eye.projection == Projection::orthographic) return {origin, eye.forward};
  return {origin, glm::normalize(eye.forward + across)};
}

// center, units: of the normalised space. Up is as usable_up has it.
Eye make_eye(const Camera& camera, int width, int height, const Vec3& center, double units);

// Lets the rays of an eye that is far from the bodies, which lie in [-1, 1], start just before these instead. At 1e12
// radii the rounding of a ray's origin alone is a tenth of a thousandth of a radius; but the axis passes through the
// target, and from there on a ray is exact. Leaves the eye as it is where one of the planes (a, b, c, d:
// ax + by + cz + d = 0) lies between. target: normalised. width, height: pixels.
void start_near_bodies(Eye& eye, const Vec3& target, int width, int height, std::span<const Vec4> planes);

}  // namespace tilelight
