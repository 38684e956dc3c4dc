// SPDX-License-Identifier: Apache-2.0
#include "renderer/geometry/lathe.h"
#include "renderer/geometry/staunton.h"

namespace tilelight {
namespace {

Profile queen_profile(int detail) {
  Profile profile = turned_foot({.radius = 0.36, .height = 0.33, .stem_radius = 0.16}, detail);
  profile.curve_to({0.13, 0.45}, {0.10, 0.6}, {0.10, 1.15});
  profile.line_to({0.14, 1.15});
  add_bead(profile, 0.14, 1.15 + 0.06);
  profile.line_to({0.12, 1.15 + 0.06});
  profile.curve_to({0.15, 1.15 + 0.1}, {0.2, 1.65 - 0.12}, {0.2, 1.65 - 0.1});
  profile.curve_to({0.16, 1.65 - 0.05}, {0.1, 1.65}, {0.0, 1.65});
  return profile;
}

}  // namespace

TriMesh make_queen(int detail) {
  MeshBuilder mesh;
  turn(mesh, queen_profile(detail), Columns(detail));
  return mesh.finish();
}

int64_t queen_triangles(int detail) { return turned_triangles(queen_profile(detail), detail); }

}  // namespace tilelight
