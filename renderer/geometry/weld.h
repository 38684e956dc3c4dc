// SPDX-License-Identifier: Apache-2.0
// Welding of positions and normals at corners: what user meshes and the chess set share. Pure; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/base/facet.h"
#include "renderer/geometry/tri_mesh.h"

namespace tilelight {

struct Weld {
  std::vector<Vec3> positions;        // each value once, in order of first use
  std::vector<uint32_t> from_source;  // place of source[i] in `positions`
};

// Positions of equal value (bit for bit, -0 as 0) become one.
Weld weld_positions(std::span<const Vec3> source);

// Fills mesh.corner_normals: the mean of the facets around a vertex, weighed by their angles there (Thuermer and
// Wuethrich 1998), over the facets that are joined by edges no sharper than crease_deg. REQUIRES: no degenerate
// triangles, welded positions. A vanishing mean falls back to the facet's normal, counted in normals_repaired.
// Where every edge is sharp none are left: the mesh is flat.
void set_crease_normals(TriMesh& mesh, double crease_deg);

}  // namespace tilelight
