// SPDX-License-Identifier: Apache-2.0
// TriangleTree: what rays walk. The scene's own tree lies in world space and holds the triangles of most meshes,
// merged, so that a ray passes from one body to the next without leaving it; beside them single bodies: spheres, boxes,
// and meshes that have a tree of their own in their local space, which all their instances share.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/compile/bvh.h"

namespace tilelight {

struct CompiledMesh;
struct CompiledScene;

// Eight triangles of a leaf in struct-of-arrays form, for the float filter: vertex, axis, triangle. Unused places are
// NaN, which no comparison lets through.
struct alignas(32) TriangleBlock {
  static constexpr uint32_t kNobody = ~uint32_t{0};
  float vertex[3][3][8];
  uint32_t body[8];  // kNobody in a mesh's own tree
  uint32_t prim[8];
  TriangleBlock() {}  // leaves it as it is: a vector of them is filled by all threads
};

struct TriangleTree {
  // A leaf reference (WideBvh::kLeafBit) with this bit is a body, else an index into blocks.
  static constexpr uint32_t kBodyBit = 0x4000'0000u;

  std::vector<WideBvh::Node> nodes;  // [0] is the root; empty if nothing is in the tree
  std::vector<TriangleBlock> blocks;
  int depth = 0;

  int64_t memory_bytes() const {
    return static_cast<int64_t>(nodes.size() * sizeof(WideBvh::Node) + blocks.size() * sizeof(TriangleBlock));
  }
};

TriangleTree build_mesh_tree(const CompiledMesh& mesh, TilePool& pool);

// Whose triangles are better merged into the scene's tree, by body.
std::vector<bool> find_merged(const CompiledScene& scene);

// REQUIRES: scene.bodies with their placement; their `tree` says who is merged.
TriangleTree build_scene_tree(const CompiledScene& scene, TilePool& pool);

}  // namespace tilelight
