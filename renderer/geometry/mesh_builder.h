// SPDX-License-Identifier: Apache-2.0
// MeshBuilder: puts a closed mesh together from patches. Patches meet where their points have equal positions, bit for
// bit; triangles that collapse by this (at a pole, at the end of a slot) vanish.
#pragma once

#include <span>
#include <vector>

#include "renderer/geometry/tri_mesh.h"

namespace tilelight {

struct SurfacePoint {
  Vec3 position;
  Vec3 normal;  // unit, outward
};

class MeshBuilder {
 public:
  void add_triangle(const SurfacePoint& a, const SurfacePoint& b, const SurfacePoint& c);

  // points[row * columns + column]; seen from outside, columns run to the right and rows run upwards. Quads are cut
  // along ridges, else along the shorter diagonal.
  void add_grid(std::span<const SurfacePoint> points, int columns);

  TriMesh finish() const;

 private:
  std::vector<SurfacePoint> corners_;  // 3 a triangle
};

}  // namespace tilelight
