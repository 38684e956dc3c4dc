// SPDX-License-Identifier: Apache-2.0
#include "renderer/geometry/sphere_mesh.h"

#include "renderer/base/elementary.h"
#include "renderer/geometry/mesh_builder.h"

namespace tilelight {
namespace {

constexpr double kQuarterTurn = 0.5 * elementary::kPi;

// The direction at part / parts of a quarter turn from (1, 0); exact at both ends.
Vec2 quarter_direction(int part, int parts) {
  if (part == 0) return {1.0, 0.0};
  if (part == parts) return {0.0, 1.0};
  const double angle = kQuarterTurn * part / parts;
  return {elementary::cos(angle), elementary::sin(angle)};
}

// Row 0 is the pole, row `detail` the equator; a row has as many places after its first as its number.
Vec3 octant_point(int row, int place, int detail) {
  if (row == 0) return {0.0, 1.0, 0.0};
  const Vec2 height = quarter_direction(detail - row, detail), around = quarter_direction(place, row);
  return {height.x * around.x, height.y, height.x * around.y};
}

void add_facet(MeshBuilder& mesh, Vec3 a, Vec3 b, Vec3 c) {
  if (glm::dot(glm::cross(b - a, c - a), a) < 0.0) std::swap(b, c);
  mesh.add_triangle({a, a}, {b, b}, {c, c});
}

}  // namespace

TriMesh make_sphere_mesh(int detail) {
  MeshBuilder mesh;
  for (int octant = 0; octant < 8; ++octant) {
    const Vec3 sign(octant & 1 ? -1.0 : 1.0, octant & 2 ? -1.0 : 1.0, octant & 4 ? -1.0 : 1.0);
    const auto at = [&](int row, int place) { return sign * octant_point(row, place, detail); };
    for (int row = 0; row < detail; ++row) {
      for (int place = 0; place <= row; ++place) {
        add_facet(mesh, at(row, place), at(row + 1, place), at(row + 1, place + 1));
        if (place < row) add_facet(mesh, at(row, place), at(row + 1, place + 1), at(row, place + 1));
      }
    }
  }
  return mesh.finish();
}

// A facet's plane is nearest to the centre at the middle of the circle about its corners. At the equator, where facets
// are largest, that circle's radius is 0.626 of an edge; no row has worse.
double sphere_mesh_error(int detail) {
  const double edge = kQuarterTurn / detail;
  return 0.21 * edge * edge;
}

}  // namespace tilelight
