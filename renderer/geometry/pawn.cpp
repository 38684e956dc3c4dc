// SPDX-License-Identifier: Apache-2.0
// The pawn: a ball on a collar.
#include "renderer/geometry/lathe.h"
#include "renderer/geometry/staunton.h"

namespace tilelight {
namespace {

Profile pawn_profile(int detail) {
  Profile profile = turned_foot({.radius = 0.285, .height = 0.27, .stem_radius = 0.142}, detail);
  profile.curve_to({0.104, 0.315}, {0.080, 0.41}, {0.080, 0.555});
  profile.line_to({0.094, 0.558});
  add_bead(profile, 0.094, 0.582);
  add_collar(profile, 0.176, 0.606, 0.060, 0.090);
  profile.ball_to({0.0, 0.95}, 2.0 * 74.0);  // the ball
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
