// SPDX-License-Identifier: Apache-2.0
// The queen: a flared bell with a scalloped coronet, and a ball that rises from it.
#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/geometry/lathe.h"
#include "renderer/geometry/staunton.h"

namespace tilelight {
namespace {

constexpr int kScallops = 8;
// The wall of the coronet, and the share of its height that is filed away between two points.
constexpr double kCoronetFoot = 1.380, kCoronetRadius = 0.163, kBowlRadius = 0.150, kRimY = 1.508, kFiledShare = 0.42;

// An even number of columns for each scallop, so that one runs through its lowest place; at most a third
// more than asked for, because the scallops turn more sharply than the body.
int queen_columns(int detail) { return round_up(detail + std::min(detail / 3, 16), 2 * kScallops); }

Profile body_profile(int detail) {
  Profile profile = turned_foot({.radius = 0.360, .height = 0.35, .stem_radius = 0.184}, detail);
  profile.curve_to({0.126, 0.41}, {0.090, 0.62}, {0.090, 0.985});
  profile.line_to({0.110, 0.990});
  add_bead(profile, 0.110, 1.026);
  add_collar(profile, 0.205, 1.058, 0.072, 0.118);
  profile.line_to({0.118, 1.098});
  add_bead(profile, 0.110, 1.132);
  profile.line_to({0.098, 1.134}).line_to({0.098, 1.150});
  profile.curve_to({0.106, 1.250}, {0.140, 1.310}, {kCoronetRadius, kCoronetFoot});
  return profile;
}

Profile crown_profile(int detail) {
  Profile profile({kBowlRadius, kCoronetFoot}, detail);
  profile.line_to({0.146, kCoronetFoot});
  profile.curve_to({0.138, 1.470}, {0.090, 1.515}, {0.036, 1.540});
  profile.line_to({0.034, 1.548});
  profile.ball_to({0.0, 1.650}, 2.0 * 71.0);
  return profile;
}

// The coronet's wall is turned and then filed down between its points: its faces stay surfaces of revolution, and the
// filed rim runs straight through from the outer to the inner face.
class Coronet {
 public:
  Coronet(const Columns& columns, int detail)
      : columns_(columns), wall_rows_(std::max(3, static_cast<int>(0.9 * std::sqrt(double(detail)) + 0.5))) {}

  void add_to(MeshBuilder& mesh) const {
    const int n = columns_.count();
    std::vector<SurfacePoint> outer, inner, rim;
    for (int i = 0; i <= wall_rows_; ++i) {
      for (int j = 0; j <= n; ++j) outer.push_back(outer_point(j, double(i) / wall_rows_));
      for (int j = 0; j <= n; ++j) inner.push_back(inner_point(j, double(wall_rows_ - i) / wall_rows_));
    }
    for (int j = 0; j <= n; ++j) rim.push_back({outer_point(j, 1.0).position, rim_normal(j)});
    for (int j = 0; j <= n; ++j) rim.push_back({inner_point(j, 1.0).position, rim_normal(j)});
    for (const auto* patch : {&outer, &rim, &inner}) mesh.add_grid(*patch, n + 1);
  }

  int64_t triangles() const { return 2 * int64_t(columns_.count()) * (2 * wall_rows_ + 1); }

 private:
  // How far column j is filed down, 1 at the deepest: wide round valleys between narrow rounded points.
  double valley(int j) const {
    const int steps = columns_.count() / kScallops;
    const double w = std::fabs(2.0 * (j % steps) / steps - 1.0), rise = 1.0 - w * w * w;
    return rise * std::sqrt(rise);
  }

  SurfacePoint wall_point(const Cubic& face, double side, int j, double u) const {
    const double t = u * (1.0 - kFiledShare * valley(j));
    const Vec2 tangent = face.tangent(t);
    return turned_point({face.position(t), side * glm::normalize(Vec2(tangent.y, -tangent.x))}, columns_.direction(j));
  }
  SurfacePoint outer_point(int j, double u) const {
    static const Cubic kFace{{kCoronetRadius, kCoronetFoot}, {0.178, 1.424}, {0.196, 1.466}, {0.204, kRimY}};
    return wall_point(kFace, 1.0, j, u);
  }
  SurfacePoint inner_point(int j, double u) const {
    static const Cubic kFace{{kBowlRadius, kCoronetFoot}, {0.158, 1.424}, {0.174, 1.466}, {0.183, kRimY}};
    return wall_point(kFace, -1.0, j, u);
  }

  Vec3 rim_normal(int j) const {
    const int n = columns_.count();
    const Vec3 along = outer_point((j + 1) % n, 1.0).position - outer_point((j + n - 1) % n, 1.0).position;
    const Vec3 inwards = inner_point(j % n, 1.0).position - outer_point(j % n, 1.0).position;
    return glm::normalize(glm::cross(along, inwards));
  }

  const Columns& columns_;
  int wall_rows_;
};

}  // namespace

TriMesh make_queen(int detail) {
  const Columns columns(queen_columns(detail));
  MeshBuilder mesh;
  turn(mesh, body_profile(detail), columns);
  Coronet(columns, detail).add_to(mesh);
  turn(mesh, crown_profile(detail), columns);
  return mesh.finish();
}

int64_t queen_triangles(int detail) {
  const Columns columns(queen_columns(detail));
  return turned_triangles(body_profile(detail), columns.count()) + Coronet(columns, detail).triangles() +
         turned_triangles(crown_profile(detail), columns.count());
}

}  // namespace tilelight
