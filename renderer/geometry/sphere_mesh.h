// SPDX-License-Identifier: Apache-2.0
// The unit sphere as triangles: an octahedron's faces, cut finely and blown up. Corners lie on the sphere; normals are
// the sphere's.
#pragma once

#include "renderer/geometry/tri_mesh.h"

namespace tilelight {

inline constexpr int kMinSphereDetail = 2, kMaxSphereDetail = 256;

// detail: edges along a quarter of a great circle. 8 * detail^2 triangles, closed, about the origin.
TriMesh make_sphere_mesh(int detail);

// No point of the mesh lies farther from the sphere than this, in radii.
double sphere_mesh_error(int detail);

}  // namespace tilelight
