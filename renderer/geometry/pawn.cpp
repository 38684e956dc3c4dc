// SPDX-License-Identifier: Apache-2.0
// The pawn: a ball on a collar.
#include "renderer/geometry/lathe.h"
#include "renderer/geometry/staunton.h"

namespace tilelight {
namespace {

Profile pawn_profile(int detail) {
  Profile profile = turned_foot({.radius = 0.285, .height = 0.27, .stem_radius = 0.135}, detail);
  profile.curve_to({0.120, 0.36}, {0.080, 0.44}, {0.078, 0.575});
  profile.line_to({0.110, 0.580});
  profile.curve_to({0.150, 0.590}, {0.165, 0.600}, {0.172, 0.612});  // the collar: a thin lens
  profile.curve_to({0.165, 0.628}, {0.140, 0.638}, {0.100, 0.646});
  profile.arc_to({0.0, 0.95}, 144.0);
  return profile;
}

}  // namespace

TriMesh make_pawn(int detail) {
  MeshBuilder mesh;
  turn(mesh, pawn_profile(detail), Columns(detail));
  return mesh.finish();
}

int64_t pawn_triangles(int detail) { return turned_triangles(pawn_profile(detail), detail); }

}  // namespace tilelight
