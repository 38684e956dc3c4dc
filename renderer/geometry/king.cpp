// SPDX-License-Identifier: Apache-2.0
// The king: a flared bell under a dome, and a cross pattee that looks along z.
#include "renderer/geometry/cross.h"
#include "renderer/geometry/lathe.h"
#include "renderer/geometry/staunton.h"

namespace tilelight {
namespace {

constexpr double kCrossFoot = 1.690;
constexpr CrossShape kCross{
    .center_y = 1.795, .reach = 0.105, .neck = 0.024, .tip = 0.056, .depth = 0.034, .chamfer = 0.008};
static_assert(kCross.center_y - kCross.reach == kCrossFoot);

Profile king_profile(int detail) {
  Profile profile = turned_foot({.radius = 0.378, .height = 0.375, .stem_radius = 0.194}, detail);
  profile.curve_to({0.134, 0.44}, {0.096, 0.68}, {0.096, 1.120});
  profile.line_to({0.118, 1.126});
  add_bead(profile, 0.118, 1.164);
  add_collar(profile, 0.218, 1.198, 0.076, 0.126);
  profile.line_to({0.126, 1.240});
  add_bead(profile, 0.118, 1.276);
  profile.line_to({0.106, 1.278}).line_to({0.106, 1.294});
  profile.curve_to({0.112, 1.390}, {0.150, 1.480}, {0.196, 1.556});  // the bell
  profile.line_to({0.206, 1.560});
  profile.arc_to({0.204, 1.588}, 110.0);
  profile.line_to({0.188, 1.592});
  profile.curve_to({0.180, 1.640}, {0.128, 1.662}, {0.062, 1.670});  // the dome
  profile.line_to({0.058, 1.674});
  profile.arc_to({0.066, kCrossFoot}, 90.0);
  return profile;
}

}  // namespace

TriMesh make_king(int detail) {
  const Columns columns(detail);
  const Profile profile = king_profile(detail);
  MeshBuilder mesh;
  turn(mesh, profile, columns);
  add_cross(mesh, kCross, profile.end().x, columns, detail);
  return mesh.finish();
}

int64_t king_triangles(int detail) {
  return turned_triangles(king_profile(detail), detail) + cross_triangles(detail, detail);
}

}  // namespace tilelight
