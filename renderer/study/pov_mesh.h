// SPDX-License-Identifier: Apache-2.0
// Triangles as POV-Ray's mesh2.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "renderer/compile/bodies.h"
#include "renderer/geometry/tri_mesh.h"

namespace tilelight {

// For each axis that a checker may leave out, the texture of the triangles that face along it.
using PovFaceTextures = std::array<std::string, 3>;

// Where POV-Ray has the mesh's places: single floats, and tolerances that no mesh may come near.
struct PovMeshSpace {
  Mat4 mesh_from_local{1.0}, local_from_mesh{1.0};
};
// size: of the mesh there, half its longest side.
PovMeshSpace pov_mesh_space(const TriMesh& mesh, double size);

// "mesh2 { ... }", without its material unless `textures` has some, which are in mesh space.
std::string pov_mesh(const TriMesh& mesh, const PovMeshSpace& space, const std::optional<PovFaceTextures>& textures);

// The axis that a checker leaves out on a triangle: the dominant one of its normal.
int dominant_axis(const TriMesh& mesh, size_t triangle);

// Calls visit for every corner of a body's triangles that have interpolated normals, in the world. facet: as long as
// the triangle is large; normal: of the corner, of any length, on the facet's side.
using PovCorner = std::function<void(const Vec3& place, const Vec3& facet, const Vec3& normal)>;
void for_each_smooth_corner(const Body& body, const PovCorner& visit);

// A box about the origin, flat faces. Faces of a box without thickness stand once.
TriMesh box_mesh(const Vec3& half);

}  // namespace tilelight
