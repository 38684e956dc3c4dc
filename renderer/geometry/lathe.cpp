// SPDX-License-Identifier: Apache-2.0
#include "renderer/geometry/lathe.h"

#include "renderer/base/elementary.h"

namespace tilelight {

Vec2 direction_at(double angle_rad) { return {elementary::cos(angle_rad), -elementary::sin(angle_rad)}; }

Columns::Columns(int count) : directions_(count + 1) {
  for (int j = 0; j < count; ++j) directions_[j] = direction_at(2.0 * elementary::kPi * j / count);
  directions_[count] = directions_[0];
}

SurfacePoint turned_point(const ProfilePoint& point, Vec2 direction) {
  const auto [r, y] = std::pair(point.position.x, point.position.y);
  return {Vec3(r * direction.x, y, r * direction.y),
          Vec3(point.normal.x * direction.x, point.normal.y, point.normal.x * direction.y)};
}

void turn(MeshBuilder& mesh, const Profile& profile, const Columns& columns) {
  std::vector<SurfacePoint> points;
  for (const ProfileRun& run : profile.runs()) {
    points.clear();
    for (const ProfilePoint& point : run)
      for (int j = 0; j <= columns.count(); ++j) points.push_back(turned_point(point, columns.direction(j)));
    mesh.add_grid(points, columns.count() + 1);
  }
}

int64_t turned_triangles(const Profile& profile, int columns) {
  int64_t triangles = 0;
  for (const ProfileRun& run : profile.runs())
    for (size_t i = 1; i < run.size(); ++i)
      triangles += int64_t(columns) * ((run[i - 1].position.x != 0.0) + (run[i].position.x != 0.0));
  return triangles;
}

}  // namespace tilelight
