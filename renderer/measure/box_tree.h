// SPDX-License-Identifier: Apache-2.0
// BoxTree: a binary tree of axis-aligned boxes, split at the median, in double. The plain acceleration of the
// reference renderer: simple enough to be believed. Immutable after construction; any thread may read.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "renderer/base/vec.h"

namespace tilelight::reference {

struct Box {
  Vec3 lo{std::numeric_limits<double>::infinity()}, hi{-std::numeric_limits<double>::infinity()};
  void include(const Vec3& p) { lo = glm::min(lo, p), hi = glm::max(hi, p); }
  void include(const Box& b) { lo = glm::min(lo, b.lo), hi = glm::max(hi, b.hi); }
  // Wider on every side by `length`.
  Box padded(double length) const { return {lo - length, hi + length}; }
};

class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(const std::vector<Box>& boxes);

  // Calls visit(index) for every box that the ray may meet in [t_min, t_max], near ones first. `t_max` is read again
  // at every step, so a visitor that finds a hit can shorten the ray. Stops when visit returns true, and returns that.
  template <class Visit>
  bool visit(const Vec3& origin, const Vec3& direction, double t_min, const double& t_max, Visit visit) const;

 private:
  struct Node {
    Box box;
    uint32_t first = 0;  // leaf: place in order_; inner: the second child (the first one follows its parent)
    uint16_t count = 0;  // leaf: number of boxes; 0 for an inner node
    uint16_t axis = 0;   // inner: the axis of the split
  };
  static constexpr int kLeafSize = 4;
  static constexpr int kMaxDepth = 64;  // a median split halves 2^32 boxes 32 times

  void build(const std::vector<Box>& boxes, uint32_t begin, uint32_t end);
  static bool meets(const Box& box, const Vec3& origin, const Vec3& inverse, double t_min, double t_max);

  std::vector<Node> nodes_;
  std::vector<uint32_t> order_;
};

// Slabs (Kay and Kajiya 1986). A zero direction component in the plane of a face gives 0 * inf = NaN, which std::min
// and std::max ignore in their second argument; the far side is widened for rounding (Ize 2013, JCGT 2(2)).
inline bool BoxTree::meets(const Box& box, const Vec3& origin, const Vec3& inverse, double t_min, double t_max) {
  constexpr double kWiden = 1.0 + 0x1p-50;
  double near = t_min, far = t_max;
  for (int k = 0; k < 3; ++k) {
    const double a = (box.lo[k] - origin[k]) * inverse[k], b = (box.hi[k] - origin[k]) * inverse[k];
    const bool is_backward = std::signbit(inverse[k]);
    near = std::max(near, is_backward ? b : a);
    far = std::min(far, (is_backward ? a : b) * kWiden);
  }
  return near <= far;
}

template <class Visit>
bool BoxTree::visit(const Vec3& origin, const Vec3& direction, double t_min, const double& t_max, Visit visit) const {
  if (nodes_.empty()) return false;
  const Vec3 inverse = 1.0 / direction;
  std::array<uint32_t, kMaxDepth> stack;
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const uint32_t index = stack[--depth];
    const Node& node = nodes_[index];
    if (!meets(node.box, origin, inverse, t_min, t_max)) continue;
    if (node.count == 0) {
      const bool second_is_near = direction[node.axis] < 0.0;
      stack[depth++] = second_is_near ? index + 1 : node.first;
      stack[depth++] = second_is_near ? node.first : index + 1;
      continue;
    }
    for (uint32_t i = node.first; i < node.first + node.count; ++i)
      if (visit(order_[i])) return true;
  }
  return false;
}

}  // namespace tilelight::reference
