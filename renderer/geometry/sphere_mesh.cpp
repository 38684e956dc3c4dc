// SPDX-License-Identifier: Apache-2.0
#include "renderer/geometry/sphere_mesh.h"

#include "renderer/base/elementary.h"
#include "renderer/geometry/mesh_builder.h"

namespace tilelight {
namespace {

constexpr double kQuarterTurn = 0.5 * elementary::kPi;

// A place of the octant, by whole weights of its corners that add up to `detail`. Sines of the weights keep the facets
// more alike than the weights themselves would: the longest edge is 1.5 of the shortest, not 2.4.
Vec3 octant_point(int x, int y, int detail) {
  const auto part = [detail](int weight) { return elementary::sin(kQuarterTurn * weight / detail); };
  return glm::normalize(Vec3(part(x), part(y), part(detail - x - y)));
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
    const auto at = [&](int x, int y) { return sign * octant_point(x, y, detail); };
    for (int x = 0; x < detail; ++x) {
      for (int y = 0; x + y < detail; ++y) {
        add_facet(mesh, at(x, y), at(x + 1, y), at(x, y + 1));
        if (x + y + 1 < detail) add_facet(mesh, at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
      }
    }
  }
  return mesh.finish();
}

// A facet's plane is nearest to the centre at the middle of the circle about its corners. Of all details and facets the
// largest such circle has a radius of 0.83 of a quarter turn over the detail.
double sphere_mesh_error(int detail) {
  const double edge = kQuarterTurn / detail;
  return 0.345 * edge * edge;
}

}  // namespace tilelight
