// SPDX-License-Identifier: Apache-2.0
#include "renderer/geometry/mesh_builder.h"

#include <cmath>

#include "renderer/geometry/weld.h"

namespace tilelight {
namespace {

double squared_distance(const Vec3& a, const Vec3& b) { return glm::dot(b - a, b - a); }

// A coarse facet may turn away from the true surface's normal at its corner; shading with it would be black. The
// normal is then bent back towards the facet until it looks the same way.
Vec3 facing(const Vec3& normal, const Vec3& facet) {
  constexpr double kMinCosine = 0.2;
  const double cosine = glm::dot(normal, facet);
  if (cosine >= kMinCosine || facet == Vec3(0.0)) return normal;
  return unit_or_zero(normal + (kMinCosine - cosine) * facet);
}

// Whether a quad is better cut from a to c than from b to d: along a ridge or groove, where the normals agree, and else
// along the shorter diagonal.
bool cuts_along_first(const SurfacePoint& a, const SurfacePoint& b, const SurfacePoint& c, const SurfacePoint& d) {
  constexpr double kSameBend = 0.01;
  const double first = glm::dot(a.normal, c.normal), second = glm::dot(b.normal, d.normal);
  if (std::fabs(first - second) > kSameBend) return first > second;
  return squared_distance(a.position, c.position) <= squared_distance(b.position, d.position);
}

}  // namespace

void MeshBuilder::add_triangle(const SurfacePoint& a, const SurfacePoint& b, const SurfacePoint& c) {
  corners_.insert(corners_.end(), {a, b, c});
}

void MeshBuilder::add_grid(std::span<const SurfacePoint> points, int columns) {
  const int rows = static_cast<int>(points.size()) / columns;
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      const SurfacePoint& a = points[row * columns + column];
      const SurfacePoint& b = points[row * columns + column + 1];
      const SurfacePoint& c = points[(row + 1) * columns + column + 1];
      const SurfacePoint& d = points[(row + 1) * columns + column];
      if (cuts_along_first(a, b, c, d)) {
        add_triangle(a, b, c);
        add_triangle(a, c, d);
      } else {
        add_triangle(a, b, d);
        add_triangle(b, c, d);
      }
    }
  }
}

TriMesh MeshBuilder::finish() const {
  std::vector<Vec3> positions(corners_.size());
  for (size_t i = 0; i < corners_.size(); ++i) positions[i] = corners_[i].position;
  Weld weld = weld_positions(positions);
  TriMesh mesh;
  mesh.positions = std::move(weld.positions);
  for (size_t i = 0; i < corners_.size(); i += 3) {
    const uint32_t a = weld.from_source[i], b = weld.from_source[i + 1], c = weld.from_source[i + 2];
    if (a == b || b == c || c == a) continue;
    const Vec3 facet = geometric_normal(positions[i], positions[i + 1], positions[i + 2]);
    mesh.triangles.push_back({a, b, c});
    mesh.corner_normals.push_back({facing(corners_[i].normal, facet), facing(corners_[i + 1].normal, facet),
                                   facing(corners_[i + 2].normal, facet)});
  }
  find_closure(mesh);
  mesh.is_known_outward = mesh.is_manifold;
  return mesh;
}

}  // namespace tilelight
