// SPDX-License-Identifier: Apache-2.0
#include "renderer/compile/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include "renderer/compile/compiled_scene.h"
#include "renderer/compile/passes.h"

namespace tilelight {
namespace {

// The triangles of one mesh, placed.
struct Part {
  uint32_t body;
  const CompiledMesh* mesh;
  std::vector<std::array<float, 3>> points;
  uint32_t first;  // of its triangles, among the items
};

// work(i) for all i below count, by idle threads of the pool too.
template <class Work>
void for_all(TilePool& pool, size_t count, const Work& work) {
  constexpr size_t kChunk = 4096;
  pool.parallel_for(static_cast<int64_t>((count + kChunk - 1) / kChunk), Priority::normal, [&](int64_t chunk) {
    const size_t first = static_cast<size_t>(chunk) * kChunk;
    for (size_t i = first; i < std::min(count, first + kChunk); ++i) work(i);
  });
}

void place(Part& part, const Mat4& to, TilePool& pool) {
  part.points.resize(part.mesh->positions.size());
  for_all(pool, part.points.size(), [&](size_t i) {
    const Vec3 at = transform_point(to, part.mesh->positions[i]);
    part.points[i] = {static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)};
  });
}

class TreeMaker {
 public:
  // singles: bodies that have a leaf of their own.
  TreeMaker(std::vector<Part> parts, std::vector<uint32_t> singles, std::span<const CompiledBody> bodies)
      : parts_(std::move(parts)), singles_(std::move(singles)), bodies_(bodies) {}

  TriangleTree make(TilePool& pool) {
    triangles_ = parts_.empty() ? 0 : parts_.back().first + static_cast<uint32_t>(parts_.back().mesh->triangles.size());
    const auto count = triangles_ + static_cast<uint32_t>(singles_.size());
    WideBvh bvh = build_bvh({count, [this](uint32_t item) { return box_of(item); }, triangles_}, WideBvh::kWidth, pool);
    TriangleTree tree;
    tree.depth = bvh.depth;
    std::vector<uint32_t> reference(bvh.leaves.size()), first_items;
    for (size_t i = 0; i < bvh.leaves.size(); ++i) {
      const uint32_t item = bvh.order[bvh.leaves[i].first];
      if (item >= triangles_) {
        reference[i] = WideBvh::kLeafBit | TriangleTree::kBodyBit | singles_[item - triangles_];
      } else {
        reference[i] = WideBvh::kLeafBit | static_cast<uint32_t>(first_items.size());
        first_items.push_back(static_cast<uint32_t>(i));
      }
    }
    tree.blocks.resize(first_items.size());
    for_all(pool, first_items.size(), [&](size_t i) { tree.blocks[i] = block_of(bvh, bvh.leaves[first_items[i]]); });
    tree.nodes = std::move(bvh.nodes);
    for_all(pool, tree.nodes.size(), [&](size_t i) {
      for (uint32_t& child : tree.nodes[i].child)
        if (child != WideBvh::kEmpty && child & WideBvh::kLeafBit) child = reference[child & ~WideBvh::kLeafBit];
    });
    return tree;
  }

 private:
  const Part& part_of(uint32_t item) const {
    const auto after = std::upper_bound(parts_.begin(), parts_.end(), item,
                                        [](uint32_t of, const Part& part) { return of < part.first; });
    return *std::prev(after);
  }

  Box box_of(uint32_t item) const {
    if (item >= triangles_) return body_bounds(bodies_[singles_[item - triangles_]]);
    const Part& part = part_of(item);
    Box box;
    for (const uint32_t v : part.mesh->triangles[item - part.first]) {
      const auto& p = part.points[v];
      box.grow(Vec3(p[0], p[1], p[2]));
    }
    return box;
  }

  TriangleBlock block_of(const WideBvh& bvh, const WideBvh::Leaf& leaf) const {
    TriangleBlock block;
    std::fill_n(&block.vertex[0][0][0], 3 * 3 * 8, std::numeric_limits<float>::quiet_NaN());
    std::fill_n(block.body, 8, TriangleBlock::kNobody);
    std::fill_n(block.prim, 8, TriangleBlock::kNobody);
    for (uint32_t lane = 0; lane < leaf.count; ++lane) {
      const uint32_t item = bvh.order[leaf.first + lane];
      const Part& part = part_of(item);
      block.body[lane] = part.body;
      block.prim[lane] = item - part.first;
      for (size_t v = 0; v < 3; ++v) {
        const auto& p = part.points[part.mesh->triangles[item - part.first][v]];
        for (size_t axis = 0; axis < 3; ++axis) block.vertex[v][axis][lane] = p[axis];
      }
    }
    return block;
  }

  std::vector<Part> parts_;  // by first
  std::vector<uint32_t> singles_;
  const std::span<const CompiledBody> bodies_;
  uint32_t triangles_ = 0;  // items; the singles come after them
};

// Near enough to a similarity that a point's rounding in the one space is about that in the other.
bool is_even(const CompiledBody& body) {
  constexpr double kMost = 256.0;
  double there = 0.0, back = 0.0;
  for (int column = 0; column < 3; ++column) {
    there += glm::dot(Vec3(body.world_from_local[column]), Vec3(body.world_from_local[column]));
    back += glm::dot(Vec3(body.local_from_world[column]), Vec3(body.local_from_world[column]));
  }
  return there * back <= kMost * kMost;
}

}  // namespace

TriangleTree build_mesh_tree(const CompiledMesh& mesh, TilePool& pool) {
  std::vector<Part> parts(1);
  parts[0] = {TriangleBlock::kNobody, &mesh, {}, 0};
  place(parts[0], Mat4(1.0), pool);
  return TreeMaker(std::move(parts), {}, {}).make(pool);
}

std::vector<bool> find_merged(const CompiledScene& scene) {
  constexpr size_t kMostCopied = 8'000'000;  // triangles of meshes that are used more than once
  std::map<const CompiledMesh*, size_t> uses;
  size_t copied = 0;
  for (const CompiledBody& body : scene.bodies) {
    if (body.kind == BodyKind::mesh) ++uses[body.mesh];
  }
  for (const auto& [mesh, count] : uses) {
    if (count > 1) copied += count * mesh->triangles.size();
  }
  std::vector<bool> merged;
  for (const CompiledBody& body : scene.bodies) {
    bool is_merged = body.kind == BodyKind::mesh && is_even(body) && (uses[body.mesh] == 1 || copied <= kMostCopied);
    if (is_merged) {
      // Triangles too small beside the scene would all have to be decided in double.
      constexpr double kLeastSize = 0x1p-13;
      const Box bounds = body_bounds(body);
      const Vec3 size = bounds.hi - bounds.lo;
      const double triangle = std::max({size.x, size.y, size.z}) / std::sqrt(1.0 + body.mesh->triangles.size());
      // Outside [-1, 1] (as a scene may be that lies too far from its origin to be centred) floats are coarser.
      const bool is_centred =
          std::max({bounds.hi.x, bounds.hi.y, bounds.hi.z, -bounds.lo.x, -bounds.lo.y, -bounds.lo.z}) <= 1.0;
      is_merged = triangle >= kLeastSize && is_centred;
    }
    merged.push_back(is_merged);
  }
  return merged;
}

TriangleTree build_scene_tree(const CompiledScene& scene, TilePool& pool) {
  std::vector<Part> parts;
  std::vector<uint32_t> singles;
  uint32_t triangles = 0;
  for (uint32_t i = 0; i < scene.finite_bodies; ++i) {
    const CompiledBody& body = scene.bodies[i];
    if (body.kind != BodyKind::mesh || body.tree) {
      singles.push_back(i);
    } else {
      parts.push_back({i, body.mesh, {}, triangles});
      triangles += static_cast<uint32_t>(body.mesh->triangles.size());
      place(parts.back(), body.world_from_local, pool);
    }
  }
  return TreeMaker(std::move(parts), std::move(singles), scene.bodies).make(pool);
}

}  // namespace tilelight
