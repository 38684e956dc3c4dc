// SPDX-License-Identifier: Apache-2.0
#include "renderer/compile/bvh.h"

#include <algorithm>
#include <array>

#include "renderer/compile/bvh_binary.h"

namespace tilelight {
namespace {

// A node of the binary tree: of its top, or of a subtree.
struct BinaryPlace {
  const std::vector<BinaryNode>* nodes;
  int index;
  const BinaryNode& node() const { return (*nodes)[static_cast<size_t>(index)]; }
  // How much there is to gain by opening it; negative: it is a leaf.
  float worth() const { return node().left < 0 ? -1.0f : node().bounds.half_area(); }
};

// A part of the wide tree, with its own count of nodes and leaves.
struct Fragment {
  std::vector<WideBvh::Node> nodes;
  std::vector<WideBvh::Leaf> leaves;
  int depth = 0;
};

// Collapses the top on one thread and what hangs below it, a subtree's part each, on all threads.
class Collapser {
 public:
  explicit Collapser(const BinaryTree& binary) : binary_(binary) {}

  void make(TilePool& pool, WideBvh& out) {
    std::vector<Fragment> parts(1);
    make(root_of(0), 1, parts[0], &below_);
    parts.resize(1 + below_.size());
    const auto for_all = [&](const auto& work) {
      pool.parallel_for(static_cast<int64_t>(below_.size()), Priority::normal,
                        [&](int64_t i) { work(static_cast<size_t>(i)); });
    };
    for_all([&](size_t i) {
      parts[1 + i].nodes.reserve(below_[i].root.node().range.count / 8);
      parts[1 + i].leaves.reserve(below_[i].root.node().range.count / 6);
      make(below_[i].root, below_[i].depth, parts[1 + i], nullptr);
    });
    std::vector<uint32_t> node_from, leaf_from;
    uint32_t nodes = 0, leaves = 0;
    for (const Fragment& part : parts) {
      node_from.push_back(nodes), leaf_from.push_back(leaves);
      nodes += static_cast<uint32_t>(part.nodes.size()), leaves += static_cast<uint32_t>(part.leaves.size());
      out.depth = std::max(out.depth, part.depth);
    }
    for (size_t i = 0; i < below_.size(); ++i) parts[0].nodes[below_[i].node].child[below_[i].child] = node_from[1 + i];
    out.nodes.resize(nodes);
    out.leaves.resize(leaves);
    std::copy(parts[0].nodes.begin(), parts[0].nodes.end(), out.nodes.begin());
    std::copy(parts[0].leaves.begin(), parts[0].leaves.end(), out.leaves.begin());
    for_all([&](size_t i) {
      Fragment& part = parts[1 + i];
      for (WideBvh::Node& node : part.nodes) {
        for (uint32_t& child : node.child)
          if (child != WideBvh::kEmpty) child += child & WideBvh::kLeafBit ? leaf_from[1 + i] : node_from[1 + i];
      }
      std::copy(part.nodes.begin(), part.nodes.end(), out.nodes.begin() + node_from[1 + i]);
      std::copy(part.leaves.begin(), part.leaves.end(), out.leaves.begin() + leaf_from[1 + i]);
    });
  }

 private:
  // What the top leaves to be collapsed by others.
  struct Below {
    BinaryPlace root;
    int depth;
    uint32_t node;  // of the top's fragment, and which child of it
    int child;
  };
  using Children = std::array<BinaryPlace, WideBvh::kWidth>;

  // Where the top's node really lies.
  BinaryPlace root_of(int top_index) const {
    const BinaryNode& node = binary_.top[static_cast<size_t>(top_index)];
    if (node.subtree < 0) return {&binary_.top, top_index};
    return {&binary_.subtrees[static_cast<size_t>(node.subtree)], 0};
  }
  BinaryPlace child_of(const BinaryPlace& place, int index) const {
    return place.nodes == &binary_.top ? root_of(index) : BinaryPlace{place.nodes, index};
  }

  // below: where to put what lies in subtrees; null: nothing is put off.
  uint32_t make(const BinaryPlace& root, int depth, Fragment& out, std::vector<Below>* below) const {
    out.depth = std::max(out.depth, depth);
    const auto index = static_cast<uint32_t>(out.nodes.size());
    out.nodes.emplace_back();
    Children children;
    const int count = open(root, children);
    for (int i = 0; i < WideBvh::kWidth; ++i) {
      const bool used = i < count;
      if (used)
        set_bounds(children[i].node().bounds, i, out.nodes[index]);
      else
        set_empty(i, out.nodes[index]);
      uint32_t child = WideBvh::kEmpty;
      if (used && children[i].node().left < 0) {
        out.leaves.push_back(children[i].node().range);
        child = WideBvh::kLeafBit | static_cast<uint32_t>(out.leaves.size() - 1);
      } else if (used && below && children[i].nodes != &binary_.top) {
        below->push_back({children[i], depth + 1, index, i});
      } else if (used) {
        child = make(children[i], depth + 1, out, below);
      }
      out.nodes[index].child[i] = child;
    }
    return index;
  }

  static void set_bounds(const Bounds& bounds, int child, WideBvh::Node& node) {
    for (int axis = 0; axis < 3; ++axis) {
      node.bounds[0][axis][child] = round_down(double{bounds.lo[axis]} - WideBvh::kWiden);
      node.bounds[1][axis][child] = round_up(double{bounds.hi[axis]} + WideBvh::kWiden);
    }
  }
  static void set_empty(int child, WideBvh::Node& node) {
    for (int axis = 0; axis < 3; ++axis)
      node.bounds[0][axis][child] = WideBvh::kNowhere, node.bounds[1][axis][child] = -WideBvh::kNowhere;
  }

  // Opens the largest inner child until there are eight. Returns how many there are.
  int open(const BinaryPlace& root, Children& children) const {
    std::array<float, WideBvh::kWidth> worth;
    children[0] = root, worth[0] = root.worth();
    int count = 1;
    while (count < WideBvh::kWidth) {
      const auto widest = static_cast<int>(std::max_element(worth.begin(), worth.begin() + count) - worth.begin());
      if (worth[widest] < 0.0f) break;
      const BinaryPlace opened = children[widest];
      for (const auto& [at, child] : {std::pair(widest, opened.node().left), std::pair(count, opened.node().right)})
        children[at] = child_of(opened, child), worth[at] = children[at].worth();
      ++count;
    }
    return count;
  }

  const BinaryTree& binary_;
  std::vector<Below> below_;
};

}  // namespace

WideBvh build_bvh(const BoxSource& boxes, int max_leaf, TilePool& pool) {
  WideBvh bvh;
  if (boxes.count == 0) return bvh;
  BinaryTree binary = build_binary_tree(boxes, max_leaf, pool);
  Collapser(binary).make(pool, bvh);
  bvh.order = std::move(binary.order);
  return bvh;
}

}  // namespace tilelight
