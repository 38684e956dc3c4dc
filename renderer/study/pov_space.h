// SPDX-License-Identifier: Apache-2.0
// PovSpace: the coordinates in which POV-Ray gets a scene. Its tolerances are fixed lengths: a shadow begins 0.001 from
// a surface, a second hit 0.0001 from the first, nothing is seen farther off than 10^7. So the scene is moved to the
// origin and scaled to hundreds of units, or to more where small bodies need it.
#pragma once

#include <vector>

#include "renderer/compile/bodies.h"
#include "renderer/compile/bvh.h"
#include "renderer/scene/scene.h"

namespace tilelight {

struct PovSpace {
  Vec3 center{0.0};    // scene units
  double scale = 1.0;  // POV-Ray's units a scene unit

  Vec3 point(const Vec3& world) const { return (world - center) * scale; }
  Mat4 from_local(const Mat4& world_from_local) const;
};

inline constexpr double kPovSceneSize = 200.0;  // from the middle of an ordinary scene to its farthest body
inline constexpr double kPovLeastDetail = 0.1;  // smaller bodies are lost in the tolerances
inline constexpr double kPovFarthest = 5e6;     // what is farther off than this may not be seen

PovSpace pov_space(const std::vector<Body>& bodies, const Camera& camera);

// One of a box's eight corners.
inline Vec3 corner_of(const Box& box, int corner) {
  return {corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y, corner & 4 ? box.hi.z : box.lo.z};
}
// The box of a body in the world; empty for a plane.
Box world_bounds(const Body& body);

}  // namespace tilelight
