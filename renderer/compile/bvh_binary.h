// SPDX-License-Identifier: Apache-2.0
// BinaryTree: the two-way tree that a WideBvh is collapsed from. Its upper part is split by all threads together, level
// by level; every subtree below by one thread. Normalised units, float, boxes rounded outward. Immutable after the
// build; any thread may read.
#pragma once

#include <vector>

#include "renderer/compile/bvh.h"

namespace tilelight {

// Four floats that a compiler keeps in one register (GCC's and Clang's vector extension); the last is idle.
using Float4 = float __attribute__((vector_size(16)));

inline Float4 min_of(Float4 a, Float4 b) { return a < b ? a : b; }
inline Float4 max_of(Float4 a, Float4 b) { return a > b ? a : b; }

struct Bounds {
  static constexpr float kFarOut = std::numeric_limits<float>::infinity();
  Float4 lo, hi;

  static Bounds none() {
    constexpr Float4 kFar = {kFarOut, kFarOut, kFarOut, kFarOut};
    return {kFar, -kFar};
  }
  void grow(const Bounds& b) { lo = min_of(lo, b.lo), hi = max_of(hi, b.hi); }
  void grow(Float4 p) { lo = min_of(lo, p), hi = max_of(hi, p); }
  // 0 for none at all.
  float half_area() const {
    const Float4 d = hi - lo;
    return d[0] >= 0.0f ? d[0] * d[1] + d[1] * d[2] + d[2] * d[0] : 0.0f;
  }
};

// The nearest float that is not above, not below x.
float round_down(double x);
float round_up(double x);

struct BinaryNode {
  Bounds bounds;
  WideBvh::Leaf range;        // of BinaryTree::order
  int left = -1, right = -1;  // -1: a leaf, or what is below lies in a subtree
  int subtree = -1;           // of the top alone: the subtree that hangs here
};

struct BinaryTree {
  std::vector<BinaryNode> top;                    // [0] is the root
  std::vector<std::vector<BinaryNode>> subtrees;  // [0] is their root, with the bounds of the top's node
  std::vector<uint32_t> order;                    // a permutation of the boxes
};

// REQUIRES: at least one box. max_leaf: see build_bvh.
BinaryTree build_binary_tree(const BoxSource& boxes, int max_leaf, TilePool& pool);

}  // namespace tilelight
