// SPDX-License-Identifier: Apache-2.0
// The queen: a flared bell with a scalloped coronet, and a ball that rises from it.
#include <cmath>
#include <vector>

#include "renderer/base/elementary.h"
#include "renderer/geometry/lathe.h"
#include "renderer/geometry/staunton.h"

namespace tilelight {
namespace {

constexpr int kScallops = 8;
// The scallops take the rim down by kScallopDepth between its points and fade out towards kCoronetFoot.
constexpr double kCoronetFoot = 1.380, kRimY = 1.506, kScallopDepth = 0.050;

// An even number of columns for each scallop, so that one runs through the lowest place.
int queen_columns(int detail) { return round_up(detail, 2 * kScallops); }

Profile body_profile(int detail) {
  Profile profile = turned_foot({.radius = 0.360, .height = 0.35, .stem_radius = 0.184}, detail);
  profile.curve_to({0.126, 0.41}, {0.090, 0.62}, {0.090, 0.985});
  profile.line_to({0.110, 0.990});
  add_bead(profile, 0.110, 1.026);
  add_collar(profile, 0.205, 1.058, 0.072, 0.118);
  profile.line_to({0.118, 1.098});
  add_bead(profile, 0.110, 1.132);
  profile.line_to({0.098, 1.134}).line_to({0.098, 1.150});
  profile.curve_to({0.106, 1.250}, {0.140, 1.310}, {0.163, kCoronetFoot});
  return profile;
}

// From kCoronetFoot over the rim and down into the bowl, to the same height.
Profile coronet_profile(int detail) {
  Profile profile({0.163, kCoronetFoot}, detail);
  profile.curve_to({0.178, 1.424}, {0.194, 1.466}, {0.200, 1.500});
  profile.arc_to({0.192, kRimY}, 100.0);
  profile.line_to({0.180, kRimY});
  profile.curve_to({0.170, 1.460}, {0.162, 1.420}, {0.156, kCoronetFoot});
  return profile;
}

Profile crown_profile(int detail) {
  Profile profile({0.156, kCoronetFoot}, detail);
  profile.line_to({0.146, 1.392});
  profile.curve_to({0.138, 1.470}, {0.090, 1.515}, {0.036, 1.540});
  profile.line_to({0.034, 1.548});
  profile.arc_to({0.0, 1.650}, 2.0 * 71.0);
  return profile;
}

// The sunken coronet: y' = y - depth * valley(s) * fade(y), with s running from one point of the rim to the next.
SurfacePoint scalloped_point(const ProfilePoint& p, Vec2 direction, double s) {
  const double r = p.position.x, u = (p.position.y - kCoronetFoot) / (kRimY - kCoronetFoot);
  const double fade = u * u * (3.0 - 2.0 * u), fade_slope = 6.0 * u * (1.0 - u) / (kRimY - kCoronetFoot);
  // Wide round valleys between narrow rounded points: (1 - w^3)^1.5, w = 0 in the valley and 1 at the points.
  const double w = std::fabs(2.0 * s - 1.0), cube = 1.0 - w * w * w, root = std::sqrt(cube);
  const double valley = cube * root;
  const double slope_by_s = (s < 0.5 ? 9.0 : -9.0) * root * w * w;
  const double valley_slope = slope_by_s * kScallops / (2.0 * elementary::kPi);  // by the angle
  SurfacePoint point = turned_point(p, direction);
  point.position.y -= kScallopDepth * valley * fade;
  // The normal is the gradient's image under the inverse transpose of the displacement.
  const double along_y = 1.0 - kScallopDepth * valley * fade_slope;
  const double along_angle = -kScallopDepth * valley_slope * fade;
  const Vec3 around(direction.y, 0.0, -direction.x);  // the way the angle grows
  const double lift = point.normal.y / along_y;
  point.normal = glm::normalize(Vec3(point.normal.x, lift, point.normal.z) - around * (lift * along_angle / r));
  return point;
}

void turn_coronet(MeshBuilder& mesh, const Profile& coronet, const Columns& columns) {
  const int steps = columns.count() / kScallops;
  std::vector<SurfacePoint> points;
  for (const ProfileRun& run : coronet.runs()) {
    points.clear();
    for (const ProfilePoint& p : run)
      for (int j = 0; j <= columns.count(); ++j)
        points.push_back(scalloped_point(p, columns.direction(j), double(j % steps) / steps));
    mesh.add_grid(points, columns.count() + 1);
  }
}

}  // namespace

TriMesh make_queen(int detail) {
  const Columns columns(queen_columns(detail));
  MeshBuilder mesh;
  turn(mesh, body_profile(detail), columns);
  turn_coronet(mesh, coronet_profile(detail), columns);
  turn(mesh, crown_profile(detail), columns);
  return mesh.finish();
}

int64_t queen_triangles(int detail) {
  const int columns = queen_columns(detail);
  return turned_triangles(body_profile(detail), columns) + turned_triangles(coronet_profile(detail), columns) +
         turned_triangles(crown_profile(detail), columns);
}

}  // namespace tilelight
