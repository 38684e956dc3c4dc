// SPDX-License-Identifier: Apache-2.0
#include "renderer/geometry/lathe.h"
#include "renderer/geometry/staunton.h"

namespace tilelight {
namespace {

Profile knight_profile(int detail) {
  Profile profile = turned_foot({.radius = 0.33, .height = 0.33, .stem_radius = 0.16}, detail);
  profile.curve_to({0.13, 0.45}, {0.10, 0.6}, {0.10, 0.8});
  profile.line_to({0.14, 0.8});
  add_bead(profile, 0.14, 0.8 + 0.06);
  profile.line_to({0.12, 0.8 + 0.06});
  profile.curve_to({0.15, 0.8 + 0.1}, {0.2, 1.3 - 0.12}, {0.2, 1.3 - 0.1});
  profile.curve_to({0.16, 1.3 - 0.05}, {0.1, 1.3}, {0.0, 1.3});
  return profile;
}

}  // namespace

TriMesh make_knight(int detail) {
  MeshBuilder mesh;
  turn(mesh, knight_profile(detail), Columns(detail));
  return mesh.finish();
}

int64_t knight_triangles(int detail) { return turned_triangles(knight_profile(detail), detail); }

}  // namespace tilelight
