// SPDX-License-Identifier: Apache-2.0
#include "renderer/compile/compiled_mesh.h"

#include <algorithm>
#include <map>

#include "renderer/compile/normalise.h"

namespace tilelight {
namespace {

// Shares equal corner normals: smooth vertices need one each, sharp ones one a face.
void share_normals(const TriMesh& mesh, CompiledMesh& out) {
  struct Less {
    bool operator()(const Vec3& a, const Vec3& b) const {
      return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    }
  };
  // By position, so that the search for an equal normal looks at a handful of candidates.
  std::vector<std::map<Vec3, uint32_t, Less>> seen(mesh.positions.size());
  out.corner_normals.reserve(mesh.triangles.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<uint32_t, 3> ids{};
    for (int c = 0; c < 3; ++c) {
      const Vec3& n = mesh.corner_normals[t][c];
      const auto [it, is_new] = seen[mesh.triangles[t][c]].try_emplace(n, static_cast<uint32_t>(out.normals.size()));
      if (is_new) out.normals.push_back(n);
      ids[c] = it->second;
    }
    out.corner_normals.push_back(ids);
  }
}

}  // namespace

std::shared_ptr<const CompiledMesh> compile_mesh(const TriMesh& mesh) {
  auto out = std::make_shared<CompiledMesh>();
  Box bounds;
  for (const Vec3& p : mesh.positions) bounds.grow(p);
  const Normalisation n = normalise(bounds);
  out->is_manifold = mesh.is_manifold;
  out->is_known_outward = mesh.is_known_outward;
  out->mesh_from_local = n.user_from_normalised();
  out->triangles = mesh.triangles;
  out->positions.reserve(mesh.positions.size());
  for (const Vec3& p : mesh.positions) out->positions.push_back((p - n.center) / n.units);
  if (!mesh.corner_normals.empty()) share_normals(mesh, *out);

  for (const Vec3& p : out->positions) out->octants[(p.x < 0.0) + 2 * (p.y < 0.0) + 4 * (p.z < 0.0)].grow(p);
  return out;
}

int64_t CompiledMesh::memory_bytes() const {
  return static_cast<int64_t>((positions.size() + normals.size()) * sizeof(Vec3) +
                              (triangles.size() + corner_normals.size()) * sizeof(triangles[0]));
}

}  // namespace tilelight
