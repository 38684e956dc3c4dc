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

// Snell's law from a medium of index `ior_from` into one of `ior_to`, bent about `shading`. spread: the angle by which
// that may be off the normal of the curved surface for which a facet stands, radians; 0 where the two normals are one.
// A normal that faces away is met grazing; reflection is total beyond the critical angle plus the spread, and up to
// there the ray leaves at the spread above the surface; what would stay under the facet is mirrored at it.
Refraction refracted(const Vec3& direction, const Vec3& geometric, const Vec3& shading, double spread, double ior_from,
                     double ior_to);

}  // namespace tilelight::reference
