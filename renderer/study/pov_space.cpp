// SPDX-License-Identifier: Apache-2.0
#include "renderer/study/pov_space.h"

#include <algorithm>
#include <cmath>

#include "renderer/base/safe_length.h"
#include "renderer/compile/normalise.h"

namespace tilelight {

Mat4 PovSpace::from_local(const Mat4& world_from_local) const {
  Mat4 out = world_from_local;
  for (int column = 0; column < 3; ++column) out[column] *= scale;
  out[3] = Vec4(point(Vec3(world_from_local[3])), 1.0);
  return out;
}

Box world_bounds(const Body& body) {
  Box local, out;
  if (body.kind == BodyKind::plane) return out;
  if (body.kind == BodyKind::mesh) {
    for (const Vec3& p : body.mesh->positions) local.grow(p);
    if (local.is_empty()) return out;
  } else {
    const Vec3 half = body.kind == BodyKind::box ? body.half : Vec3(1.0);
    local.grow(-half), local.grow(half);
  }
  for (int corner = 0; corner < 8; ++corner)
    out.grow(Vec3(body.world_from_local * Vec4(corner_of(local, corner), 1.0)));
  return out;
}

PovSpace pov_space(const std::vector<Body>& bodies, const Camera& camera) {
  constexpr double kDetail = 10.0;   // of the smallest body, if all others allow it
  constexpr double kFarthest = 1e6;  // of the farthest body or the eye then
  Box all;
  double smallest = 0.0;
  for (const Body& body : bodies) {
    const Box box = world_bounds(body);
    if (box.is_empty()) continue;
    all.grow(box);
    const double size = safe_length(box.hi - box.lo);
    if (size > 0.0) smallest = smallest > 0.0 ? std::min(smallest, size) : size;
  }
  if (all.is_empty()) return {camera.position, kPovSceneSize / safe_length(camera.target - camera.position)};
  const Normalisation to = normalise(all);
  const double units = smallest > 0.0 ? to.units : safe_length(camera.target - camera.position);
  const double farthest = std::max(units, safe_length(camera.position - to.center));
  const double wanted = std::max(kPovSceneSize / units, smallest > 0.0 ? kDetail / smallest : 0.0);
  return {to.center, std::min(wanted, std::max(kFarthest / farthest, kPovSceneSize / units))};
}

}  // namespace tilelight
