// SPDX-License-Identifier: Apache-2.0
// The rook: a stout tower. Its wall is sawn through along parallel sides, so that six merlons stand.
#include <cmath>
#include <vector>

#include "renderer/base/elementary.h"
#include "renderer/geometry/lathe.h"
#include "renderer/geometry/staunton.h"

namespace tilelight {
namespace {

constexpr int kMerlons = 6;
constexpr double kGapWidth = 0.078;
// The wall at the bottom of a gap, and its top.
constexpr double kOuter = 0.2255, kInner = 0.150, kGapY = 1.002, kTopY = 1.100;

// A third of the columns go to the gaps: nearly their share of the circumference.
int columns_per_gap(int detail) { return round_up(detail, 3 * kMerlons) / (3 * kMerlons); }
int rook_columns(int detail) { return 3 * kMerlons * columns_per_gap(detail); }

Profile tower_profile(int detail) {
  Profile profile = turned_foot({.radius = 0.325, .height = 0.30, .stem_radius = 0.176}, detail);
  profile.curve_to({0.146, 0.35}, {0.136, 0.48}, {0.138, 0.655});
  profile.line_to({0.156, 0.659});
  add_bead(profile, 0.156, 0.690);
  add_collar(profile, 0.212, 0.716, 0.062, 0.158);
  profile.line_to({0.158, 0.760});
  profile.curve_to({0.160, 0.815}, {0.180, 0.838}, {0.212, 0.850});  // a cove under the wall
  profile.line_to({0.221, 0.858}).line_to({0.221, 0.880}).line_to({0.214, 0.884});
  profile.line_to({kOuter, kGapY});
  return profile;
}

Profile merlon_profile(int detail) {
  Profile profile({kOuter, kGapY}, detail);
  profile.line_to({0.234, kTopY - 0.010});
  profile.arc_to({0.225, kTopY}, 80.0);
  profile.line_to({0.156, kTopY});
  profile.arc_to({0.149, kTopY - 0.007}, 85.0);
  profile.line_to({kInner, kGapY});
  return profile;
}

Profile well_profile(int detail) {
  Profile profile({kInner, kGapY}, detail);
  profile.line_to({kInner, 0.985});
  profile.curve_to({0.120, 0.972}, {0.060, 0.985}, {0.0, 0.992});
  return profile;
}

// Columns are counted from the clockwise side of gap 0: a sector is a gap, then a merlon of twice as many columns.
// The sides of a gap are parallel, so the angle of a column depends on the radius.
Vec2 column_direction(int column, int gap_steps, double r) {
  const int sector = column / (3 * gap_steps) % kMerlons, step = column % (3 * gap_steps);
  const double pitch = 2.0 * elementary::kPi / kMerlons;
  const double half_gap = elementary::atan2(0.5 * kGapWidth, std::sqrt(r * r - 0.25 * kGapWidth * kGapWidth));
  const double angle = step <= gap_steps ? half_gap * (2.0 * step / gap_steps - 1.0)
                                         : half_gap + (pitch - 2.0 * half_gap) * (step - gap_steps) / (2.0 * gap_steps);
  return direction_at(pitch * sector + angle);
}

Columns columns_at(int gap_steps, double r) {
  std::vector<Vec2> directions;
  for (int j = 0; j <= 3 * kMerlons * gap_steps; ++j) directions.push_back(column_direction(j, gap_steps, r));
  return Columns(std::move(directions));
}

// The runs of a profile over the columns first..last, whose directions follow the radius.
void turn_sector(MeshBuilder& mesh, const Profile& profile, int gap_steps, int first, int last) {
  std::vector<SurfacePoint> points;
  for (const ProfileRun& run : profile.runs()) {
    points.clear();
    for (const ProfilePoint& p : run)
      for (int j = first; j <= last; ++j)
        points.push_back(turned_point(p, column_direction(j, gap_steps, p.position.x)));
    mesh.add_grid(points, last - first + 1);
  }
}

// The sawn side of a merlon at one of its border columns, as a strip between the outer and the inner half of its
// outline.
void add_sawn_side(MeshBuilder& mesh, const Profile& merlon, int gap_steps, int column, const Vec3& normal) {
  std::vector<SurfacePoint> outline;
  for (const ProfileRun& run : merlon.runs())
    for (size_t i = outline.empty() ? 0 : 1; i < run.size(); ++i)
      outline.push_back(
          {turned_point(run[i], column_direction(column, gap_steps, run[i].position.x)).position, normal});
  const bool outer_is_left = column % (3 * gap_steps) == 0;  // on a merlon's last column, seen from the gap
  std::vector<SurfacePoint> strip;
  for (size_t lo = 0, hi = outline.size() - 1; lo <= hi; ++lo, --hi) {
    strip.push_back(outline[outer_is_left ? lo : hi]);
    strip.push_back(outline[outer_is_left ? hi : lo]);
  }
  mesh.add_grid(strip, 2);
}

}  // namespace

TriMesh make_rook(int detail) {
  const int gap_steps = columns_per_gap(detail);
  const Profile merlon = merlon_profile(detail);
  MeshBuilder mesh;
  turn(mesh, tower_profile(detail), columns_at(gap_steps, kOuter));
  turn(mesh, well_profile(detail), columns_at(gap_steps, kInner));
  Profile gap_floor({kOuter, kGapY}, detail);
  gap_floor.line_to({kInner, kGapY});
  for (int sector = 0; sector < kMerlons; ++sector) {
    const int gap = 3 * gap_steps * sector, right = gap + gap_steps, left = gap + 3 * gap_steps;
    const Vec2 along = direction_at(2.0 * elementary::kPi * sector / kMerlons);
    const Vec2 next = direction_at(2.0 * elementary::kPi * (sector + 1) / kMerlons);
    turn_sector(mesh, gap_floor, gap_steps, gap, right);
    turn_sector(mesh, merlon, gap_steps, right, left);
    add_sawn_side(mesh, merlon, gap_steps, right, Vec3(-along.y, 0.0, along.x));
    add_sawn_side(mesh, merlon, gap_steps, left, Vec3(next.y, 0.0, -next.x));
  }
  return mesh.finish();
}

int64_t rook_triangles(int detail) {
  const int gap_steps = columns_per_gap(detail);
  const Profile merlon = merlon_profile(detail);
  const int64_t gap_floors = 2 * gap_steps, merlons = 2 * 2 * gap_steps * merlon.segments();
  const int64_t sawn_sides = 2 * (merlon.segments() - 1);  // a polygon of segments + 1 corners has that many triangles
  return turned_triangles(tower_profile(detail), rook_columns(detail)) +
         turned_triangles(well_profile(detail), rook_columns(detail)) + kMerlons * (gap_floors + merlons + sawn_sides);
}

}  // namespace tilelight
