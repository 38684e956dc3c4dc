// SPDX-License-Identifier: Apache-2.0
#include "renderer/geometry/lathe.h"
#include "renderer/geometry/staunton.h"

namespace tilelight {
namespace {

Profile bishop_profile(int detail) {
  Profile profile = turned_foot({.radius = 0.33, .height = 0.33, .stem_radius = 0.16}, detail);
  profile.curve_to({0.13, 0.45}, {0.10, 0.6}, {0.10, 0.95});
  profile.line_to({0.14, 0.95});
  add_bead(profile, 0.14, 0.95 + 0.06);
  profile.line_to({0.12, 0.95 + 0.06});
  profile.curve_to({0.15, 0.95 + 0.1}, {0.2, 1.4 - 0.12}, {0.2, 1.4 - 0.1});
  profile.curve_to({0.16, 1.4 - 0.05}, {0.1, 1.4}, {0.0, 1.4});
  return profile;
}

}  // namespace

TriMesh make_bishop(int detail) {
  MeshBuilder mesh;
  turn(mesh, bishop_profile(detail), Columns(detail));
  return mesh.finish();
}

int64_t bishop_triangles(int detail) { return turned_triangles(bishop_profile(detail), detail); }

}  // namespace tilelight
