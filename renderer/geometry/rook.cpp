// SPDX-License-Identifier: Apache-2.0
#include "renderer/geometry/lathe.h"
#include "renderer/geometry/staunton.h"

namespace tilelight {
namespace {

Profile rook_profile(int detail) {
  Profile profile = turned_foot({.radius = 0.32, .height = 0.33, .stem_radius = 0.16}, detail);
  profile.curve_to({0.13, 0.45}, {0.10, 0.6}, {0.10, 0.7});
  profile.line_to({0.14, 0.7});
  add_bead(profile, 0.14, 0.7 + 0.06);
  profile.line_to({0.12, 0.7 + 0.06});
  profile.curve_to({0.15, 0.7 + 0.1}, {0.2, 1.1 - 0.12}, {0.2, 1.1 - 0.1});
  profile.curve_to({0.16, 1.1 - 0.05}, {0.1, 1.1}, {0.0, 1.1});
  return profile;
}

}  // namespace

TriMesh make_rook(int detail) {
  MeshBuilder mesh;
  turn(mesh, rook_profile(detail), Columns(detail));
  return mesh.finish();
}

int64_t rook_triangles(int detail) { return turned_triangles(rook_profile(detail), detail); }

}  // namespace tilelight
