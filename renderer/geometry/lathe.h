// SPDX-License-Identifier: Apache-2.0
// The lathe: turns a profile about the y axis.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/geometry/mesh_builder.h"
#include "renderer/geometry/profile.h"

namespace tilelight {

// Directions around the axis, counter-clockwise seen from above; the last one repeats the first.
class Columns {
 public:
  explicit Columns(int count);  // evenly spread
  explicit Columns(std::vector<Vec2> directions) : directions_(std::move(directions)) {}
  int count() const { return static_cast<int>(directions_.size()) - 1; }
  // The x and z of a column's direction. 0 <= column <= count().
  Vec2 direction(int column) const { return directions_[column]; }

 private:
  std::vector<Vec2> directions_;
};

SurfacePoint turned_point(const ProfilePoint& point, Vec2 direction);

// The direction at an angle from +x, counter-clockwise seen from above.
Vec2 direction_at(double angle_rad);

// Adds the surface of revolution of every run of the profile.
void turn(MeshBuilder& mesh, const Profile& profile, const Columns& columns);

// The triangles that `turn` makes: two for a quad, one where the profile touches the axis.
int64_t turned_triangles(const Profile& profile, int columns);

}  // namespace tilelight
