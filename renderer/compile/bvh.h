// SPDX-License-Identifier: Apache-2.0
// WideBvh: an 8-wide bounding volume tree over boxes in a normalised space (coordinates in about [-1, 1]). Built by
// binned SAH (Wald 2007) as a binary tree, then collapsed to 8 children a node. Immutable after the build; any thread
// may read. The same boxes give the same tree on any number of threads.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "renderer/base/vec.h"
#include "renderer/schedule/tile_pool.h"

namespace tilelight {

struct Box {
  Vec3 lo{std::numeric_limits<double>::infinity()}, hi{-std::numeric_limits<double>::infinity()};
  void grow(const Vec3& p) { lo = glm::min(lo, p), hi = glm::max(hi, p); }
  void grow(const Box& b) { lo = glm::min(lo, b.lo), hi = glm::max(hi, b.hi); }
  bool is_empty() const { return !(lo.x <= hi.x); }
  double half_area() const {
    if (is_empty()) return 0.0;
    const Vec3 d = hi - lo;
    return d.x * d.y + d.y * d.z + d.z * d.x;
  }
};

struct WideBvh {
  static constexpr int kWidth = 8;
  static constexpr uint32_t kLeafBit = 0x8000'0000u;  // the rest of a leaf reference is an index into leaves
  static constexpr uint32_t kEmpty = 0xFFFF'FFFFu;    // no child; its box is inverted and never hit

  // Boxes in struct-of-arrays form: bounds[0] the lower and bounds[1] the upper planes, by axis, by child. Rounded
  // outward and widened by kWiden, which covers the rounding of a re-centred float ray (see kernel notes).
  struct alignas(64) Node {
    float bounds[2][3][kWidth];
    uint32_t child[kWidth];
  };
  struct Leaf {
    uint32_t first = 0, count = 0;  // a range of `order`
  };
  static constexpr float kWiden = 0x1p-19f;
  static constexpr float kNowhere = 1e30f;  // where the inverted box of no child lies

  std::vector<Node> nodes;  // [0] is the root; empty if there are no boxes
  std::vector<Leaf> leaves;
  std::vector<uint32_t> order;  // a permutation of the boxes
  int depth = 0;
};

// The boxes of a tree, by index. box_of is called once for each, by any thread of the pool.
struct BoxSource {
  uint32_t count = 0;
  std::function<Box(uint32_t)> box_of;
  uint32_t alone_from = ~uint32_t{0};  // boxes from here on have a leaf each
};

// max_leaf: boxes a leaf may hold, 1..8. Uses idle threads of the pool for large inputs.
WideBvh build_bvh(const BoxSource& boxes, int max_leaf, TilePool& pool);

}  // namespace tilelight
