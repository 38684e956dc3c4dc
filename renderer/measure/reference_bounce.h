// SPDX-License-Identifier: Apache-2.0
// Directions after mirrors and interfaces, and the weight of each. Pure; any thread.
#pragma once

#include <optional>

#include "renderer/base/vec.h"

namespace tilelight::reference {

// The mirror direction about `shading`; about `geometric` where that one would go under the surface. Normals are turned
// against `direction`.
Vec3 reflected(const Vec3& direction, const Vec3& geometric, const Vec3& shading);

struct Refraction {
  std::optional<Vec3> direction;  // none: total internal reflection
  double fresnel = 1.0;           // reflectance of unpolarised light
};

// Snell's law from a medium of index `ior_from` into one of `ior_to`, bent about `shading`; about `geometric` where the
// shading normal faces away or would keep the ray on its side.
Refraction refracted(const Vec3& direction, const Vec3& geometric, const Vec3& shading, double ior_from, double ior_to);

}  // namespace tilelight::reference
