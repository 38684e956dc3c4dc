// SPDX-License-Identifier: Apache-2.0
#include "renderer/geometry/tri_mesh.h"

#include <algorithm>

#include "renderer/geometry/weld.h"

namespace tilelight {
namespace {

// The normals as given, one a position; zero ones take the facet's.
void set_given_normals(TriMesh& mesh, const MeshData& data, const std::vector<uint32_t>& source_triangles) {
  mesh.corner_normals.resize(mesh.triangles.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& tri = mesh.triangles[t];
    for (uint32_t k = 0; k < 3; ++k) {
      const Vec3 given = unit_or_zero(data.normals[data.indices[3 * source_triangles[t] + k]]);
      const bool missing = given == Vec3(0.0);
      mesh.normals_repaired += missing;
      mesh.corner_normals[t][k] =
          missing ? geometric_normal(mesh.positions[tri[0]], mesh.positions[tri[1]], mesh.positions[tri[2]]) : given;
    }
  }
}

}  // namespace

TriMesh make_tri_mesh(const MeshData& data) {
  TriMesh mesh;
  std::vector<Vec3> corners;  // of the triangles that are kept, so that unused positions do not widen the bounds
  std::vector<uint32_t> source_triangles;
  for (uint32_t t = 0; t < data.indices.size() / 3; ++t) {
    const Vec3& a = data.positions[data.indices[3 * t]];
    const Vec3& b = data.positions[data.indices[3 * t + 1]];
    const Vec3& c = data.positions[data.indices[3 * t + 2]];
    if (geometric_normal(a, b, c) == Vec3(0.0)) {
      ++mesh.degenerate_dropped;
      continue;
    }
    corners.insert(corners.end(), {a, b, c});
    source_triangles.push_back(t);
  }
  Weld weld = weld_positions(corners);
  mesh.positions = std::move(weld.positions);
  mesh.triangles.resize(source_triangles.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    for (size_t k = 0; k < 3; ++k) mesh.triangles[t][k] = weld.from_source[3 * t + k];
  if (data.normals.empty())
    set_crease_normals(mesh, data.crease_deg);
  else
    set_given_normals(mesh, data, source_triangles);
  find_closure(mesh);
  return mesh;
}

void find_closure(TriMesh& mesh) {
  mesh.closed = mesh.is_manifold = false;
  std::vector<uint64_t> edges, opposites;
  edges.reserve(3 * mesh.triangles.size());
  opposites.reserve(3 * mesh.triangles.size());
  for (const auto& tri : mesh.triangles) {
    for (size_t k = 0; k < 3; ++k) {
      const uint64_t from = tri[k], to = tri[(k + 1) % 3];
      if (from == to) return;
      edges.push_back(from << 32 | to);
      opposites.push_back(to << 32 | from);
    }
  }
  std::sort(edges.begin(), edges.end());
  std::sort(opposites.begin(), opposites.end());
  mesh.closed = !edges.empty() && edges == opposites;
  mesh.is_manifold = mesh.closed && std::adjacent_find(edges.begin(), edges.end()) == edges.end();
}

}  // namespace tilelight
