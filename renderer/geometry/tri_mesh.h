// SPDX-License-Identifier: Apache-2.0
// TriMesh: triangles with a normal at every corner, so that one vertex can be smooth on one side of a crease and sharp
// on the other. Object space, double. A plain value; made once and shared by every instance.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "renderer/base/vec.h"
#include "renderer/scene/scene.h"

namespace tilelight {

struct TriMesh {
  std::vector<Vec3> positions;
  std::vector<std::array<uint32_t, 3>> triangles;   // counter-clockwise from outside
  std::vector<std::array<Vec3, 3>> corner_normals;  // unit, one triple a triangle; empty = flat everywhere
  bool closed = false;                              // every edge is used as often one way as the other
  bool is_manifold = false;                         // closed, and every edge is used exactly twice
  bool is_known_outward = false;   // made by the program: closed, outward everywhere, and nowhere through itself
  int64_t degenerate_dropped = 0;  // triangles of zero area that were left out
  int64_t normals_repaired = 0;    // zero or missing normals replaced by the geometric one
};

// A user's mesh: degenerate triangles dropped and counted, normals averaged by angle and split at crease_deg
// (Thuermer and Wuethrich 1998), or taken as given. Zero normals fall back to the geometric one, counted.
TriMesh make_tri_mesh(const MeshData& data);

// Sets closed and is_manifold.
void find_closure(TriMesh& mesh);

}  // namespace tilelight
