// SPDX-License-Identifier: Apache-2.0
#include "renderer/compile/compiled_mesh.h"

#include <algorithm>
#include <limits>
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

TriangleBlock make_block(const CompiledMesh& mesh, const WideBvh::Leaf& leaf) {
  TriangleBlock block;
  std::fill_n(&block.vertex[0][0][0], 3 * 3 * 8, std::numeric_limits<float>::quiet_NaN());
  std::fill_n(block.id, 8, ~uint32_t{0});
  for (uint32_t lane = 0; lane < leaf.count; ++lane) {
    const uint32_t id = mesh.bvh.order[leaf.first + lane];
    block.id[lane] = id;
    for (int v = 0; v < 3; ++v) {
      const Vec3& p = mesh.positions[mesh.triangles[id][v]];
      for (int axis = 0; axis < 3; ++axis) block.vertex[v][axis][lane] = static_cast<float>(p[axis]);
    }
  }
  return block;
}

}  // namespace

std::shared_ptr<const CompiledMesh> compile_mesh(const TriMesh& mesh, TilePool& pool) {
  auto out = std::make_shared<CompiledMesh>();
  Box bounds;
  for (const Vec3& p : mesh.positions) bounds.grow(p);
  const Normalisation n = normalise(bounds);
  out->closed = mesh.closed;
  out->mesh_from_local = n.user_from_normalised();
  out->triangles = mesh.triangles;
  out->positions.reserve(mesh.positions.size());
  for (const Vec3& p : mesh.positions) out->positions.push_back((p - n.center) / n.units);
  if (!mesh.corner_normals.empty()) share_normals(mesh, *out);

  std::vector<Box> boxes(mesh.triangles.size());
  for (size_t t = 0; t < boxes.size(); ++t) {
    for (const uint32_t v : mesh.triangles[t]) boxes[t].grow(out->positions[v]);
  }
  out->bvh = build_bvh(boxes, 8, pool);
  out->blocks.reserve(out->bvh.leaves.size());
  for (const WideBvh::Leaf& leaf : out->bvh.leaves) out->blocks.push_back(make_block(*out, leaf));
  return out;
}

int64_t CompiledMesh::memory_bytes() const {
  return static_cast<int64_t>(bvh.nodes.size() * sizeof(WideBvh::Node) + bvh.leaves.size() * sizeof(WideBvh::Leaf) +
                              bvh.order.size() * sizeof(uint32_t) + blocks.size() * sizeof(TriangleBlock) +
                              (positions.size() + normals.size()) * sizeof(Vec3) +
                              (triangles.size() + corner_normals.size()) * sizeof(triangles[0]));
}

}  // namespace tilelight
