// SPDX-License-Identifier: Apache-2.0
// Shells: the closed surfaces of which a mesh is made, and which of them are wound inside out. Pure; any thread.
#pragma once

#include <vector>

#include "renderer/geometry/tri_mesh.h"

namespace tilelight {

struct Shells {
  std::vector<uint32_t> of_triangle;  // a number from 0 on
  std::vector<double> volume;         // by shell; signed, positive where it is wound outwards; of no particular unit
};
// Facets that meet in an edge of two are of one shell. What is no closed surface by itself (a face that two bodies
// share, a facet that is there twice) goes with what bounds the same material at its edges. REQUIRES: a closed mesh.
Shells find_shells(const TriMesh& mesh);

// Whether it holds any volume at all: a sheet with a back holds none.
bool holds_volume(const Shells& shells);

// The triangles that are wound inside out: all if the mesh's whole volume is negative, and then the shells of negative
// volume that are no cavity of another one. Empty if none is. REQUIRES: a closed mesh and its shells.
std::vector<bool> find_inside_out(const TriMesh& mesh, const Shells& shells);

// The mesh with these triangles wound the other way.
TriMesh with_turned(const TriMesh& mesh, const std::vector<bool>& is_turned);

}  // namespace tilelight
