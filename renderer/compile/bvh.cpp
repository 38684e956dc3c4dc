// SPDX-License-Identifier: Apache-2.0
#include "renderer/compile/bvh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace tilelight {
namespace {

constexpr int kBins = 16;
// Under this depth the split falls back to halves by index, so the tree never gets deeper than about 64 levels, also
// for a hundred thousand equal boxes.
constexpr int kMaxSahDepth = 40;
constexpr int64_t kParallelMin = 1 << 14;  // boxes; smaller subtrees cost less than handing them out

struct Range {
  uint32_t first, count;
};

struct BinaryNode {
  Box box;
  Range range{};
  int left = -1, right = -1;  // -1: a leaf
};

float round_down(double x) {
  const float f = static_cast<float>(x);
  return f <= x ? f : std::nextafterf(f, -std::numeric_limits<float>::infinity());
}
float round_up(double x) {
  const float f = static_cast<float>(x);
  return f >= x ? f : std::nextafterf(f, std::numeric_limits<float>::infinity());
}

class Builder {
 public:
  Builder(const std::vector<Box>& boxes, int max_leaf) : boxes_(boxes), max_leaf_(max_leaf) {
    order_.resize(boxes.size());
    std::iota(order_.begin(), order_.end(), 0u);
    centroids_.reserve(boxes.size());
    for (const Box& b : boxes) centroids_.push_back(0.5 * (b.lo + b.hi));
  }

  // A subtree whose split is still to be done.
  struct Job {
    Range range;
    int depth;
    std::vector<BinaryNode> nodes;  // the finished subtree, [0] its root
  };

  std::vector<BinaryNode> build(TilePool& pool) {
    std::vector<BinaryNode> top;
    std::vector<Job> jobs;
    std::vector<int> job_place;
    const Range all{0, static_cast<uint32_t>(boxes_.size())};
    split_top(all, 0, top, jobs, job_place);
    pool.parallel_for(static_cast<int64_t>(jobs.size()), Priority::normal, [&](int64_t i) {
      Job& job = jobs[static_cast<size_t>(i)];
      split(job.range, job.depth, job.nodes);
    });
    for (size_t i = 0; i < jobs.size(); ++i) graft(top, job_place[i], jobs[i].nodes);
    return top;
  }

  std::vector<uint32_t> take_order() { return std::move(order_); }

 private:
  Box bounds_of(Range r) const {
    Box box;
    for (uint32_t i = r.first; i < r.first + r.count; ++i) box.grow(boxes_[order_[i]]);
    return box;
  }

  // Splits until subtrees are small enough to be jobs of their own.
  int split_top(Range r, int depth, std::vector<BinaryNode>& nodes, std::vector<Job>& jobs, std::vector<int>& places) {
    const int me = static_cast<int>(nodes.size());
    nodes.push_back({bounds_of(r), r});
    if (r.count < kParallelMin) {
      jobs.push_back({r, depth, {}});
      places.push_back(me);
      return me;
    }
    const uint32_t mid = partition(r, depth);
    if (mid == 0) return me;
    const int left = split_top({r.first, mid}, depth + 1, nodes, jobs, places);
    const int right = split_top({r.first + mid, r.count - mid}, depth + 1, nodes, jobs, places);
    nodes[me].left = left, nodes[me].right = right;
    return me;
  }

  int split(Range r, int depth, std::vector<BinaryNode>& nodes) {
    const int me = static_cast<int>(nodes.size());
    nodes.push_back({bounds_of(r), r});
    const uint32_t mid = r.count <= 1 ? 0 : partition(r, depth);
    if (mid == 0) return me;
    const int left = split({r.first, mid}, depth + 1, nodes);
    const int right = split({r.first + mid, r.count - mid}, depth + 1, nodes);
    nodes[me].left = left, nodes[me].right = right;
    return me;
  }

  static void graft(std::vector<BinaryNode>& top, int place, const std::vector<BinaryNode>& sub) {
    const int base = static_cast<int>(top.size()) - 1;  // sub[i] lands at base + i for i >= 1, sub[0] at `place`
    const auto shift = [&](BinaryNode n) {
      if (n.left >= 0) n.left += base, n.right += base;
      return n;
    };
    top[place] = shift(sub[0]);
    for (size_t i = 1; i < sub.size(); ++i) top.push_back(shift(sub[i]));
  }

  // Reorders the range and returns the size of its left part; 0: a leaf is better.
  uint32_t partition(Range r, int depth) {
    Box centroid_box;
    for (uint32_t i = r.first; i < r.first + r.count; ++i) centroid_box.grow(centroids_[order_[i]]);
    const Vec3 extent = centroid_box.hi - centroid_box.lo;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    if (!(extent[axis] > 0.0) || depth >= kMaxSahDepth) return halve(r);

    const double lo = centroid_box.lo[axis];
    const double scale = kBins / extent[axis];
    const auto bin_of = [&](uint32_t i) {
      // The minimum comes before the conversion: a denormal extent makes the scale infinite.
      return static_cast<int>(std::min(kBins - 1.0, (centroids_[i][axis] - lo) * scale));
    };
    std::array<Box, kBins> bins{};
    std::array<uint32_t, kBins> counts{};
    for (uint32_t i = r.first; i < r.first + r.count; ++i) {
      const int b = bin_of(order_[i]);
      bins[b].grow(boxes_[order_[i]]);
      ++counts[b];
    }
    const Split best = best_split(bins, counts);
    const double leaf_cost = bounds_of(r).half_area() * blocks_of(r.count);
    if (best.bin < 0 || (r.count <= static_cast<uint32_t>(max_leaf_) && best.cost >= leaf_cost)) return halve(r);
    auto* first = order_.data() + r.first;
    auto* mid = std::stable_partition(first, first + r.count, [&](uint32_t i) { return bin_of(i) < best.bin; });
    return static_cast<uint32_t>(mid - first);
  }

  struct Split {
    int bin;  // at which the right side begins; -1: none
    double cost;
  };
  Split best_split(const std::array<Box, kBins>& bins, const std::array<uint32_t, kBins>& counts) const {
    std::array<double, kBins> right_cost{};
    Box box;
    uint32_t count = 0;
    for (int b = kBins - 1; b > 0; --b) {
      box.grow(bins[b]);
      count += counts[b];
      right_cost[b] = box.half_area() * blocks_of(count);
    }
    box = Box();
    count = 0;
    int best = -1;
    double best_cost = std::numeric_limits<double>::infinity();
    const uint32_t total = std::accumulate(counts.begin(), counts.end(), 0u);
    for (int b = 1; b < kBins; ++b) {
      box.grow(bins[b - 1]);
      count += counts[b - 1];
      const double cost = box.half_area() * blocks_of(count) + right_cost[b];
      if (count > 0 && count < total && cost < best_cost) best = b, best_cost = cost;
    }
    return {best, best_cost};
  }

  // A leaf is tested a block of max_leaf boxes at a time, so cost goes by blocks.
  double blocks_of(uint32_t count) const {
    const auto block = static_cast<uint32_t>(max_leaf_);
    return static_cast<double>((count + block - 1) / block);
  }

  uint32_t halve(Range r) const { return r.count <= static_cast<uint32_t>(max_leaf_) ? 0 : r.count / 2; }

  const std::vector<Box>& boxes_;
  int max_leaf_;
  std::vector<uint32_t> order_;
  std::vector<Vec3> centroids_;
};

class Collapser {
 public:
  Collapser(const std::vector<BinaryNode>& binary, WideBvh& out) : binary_(binary), out_(out) {}

  uint32_t make(int root, int depth) {
    out_.depth = std::max(out_.depth, depth);
    const auto index = static_cast<uint32_t>(out_.nodes.size());
    out_.nodes.emplace_back();
    std::vector<int> children = open(root);
    std::array<uint32_t, WideBvh::kWidth> refs{};
    for (size_t i = 0; i < refs.size(); ++i) {
      refs[i] = i < children.size() ? reference(children[i], depth) : WideBvh::kEmpty;
    }
    WideBvh::Node& node = out_.nodes[index];
    for (int i = 0; i < WideBvh::kWidth; ++i) {
      node.child[i] = refs[i];
      for (int axis = 0; axis < 3; ++axis) {
        const bool used = i < static_cast<int>(children.size());
        node.bounds[0][axis][i] = used ? round_down(binary_[children[i]].box.lo[axis] - WideBvh::kWiden) : 4.0f;
        node.bounds[1][axis][i] = used ? round_up(binary_[children[i]].box.hi[axis] + WideBvh::kWiden) : -4.0f;
      }
    }
    return index;
  }

 private:
  // Opens the largest inner child until there are eight.
  std::vector<int> open(int root) const {
    std::vector<int> children{root};
    while (children.size() < WideBvh::kWidth) {
      int widest = -1;
      for (size_t i = 0; i < children.size(); ++i) {
        if (binary_[children[i]].left < 0) continue;
        if (widest < 0 || binary_[children[i]].box.half_area() > binary_[children[widest]].box.half_area()) {
          widest = static_cast<int>(i);
        }
      }
      if (widest < 0) break;
      const BinaryNode& opened = binary_[children[widest]];
      children[widest] = opened.left;
      children.push_back(opened.right);
    }
    return children;
  }

  uint32_t reference(int child, int depth) {
    if (binary_[child].left >= 0) return make(child, depth + 1);
    out_.leaves.push_back({binary_[child].range.first, binary_[child].range.count});
    return WideBvh::kLeafBit | static_cast<uint32_t>(out_.leaves.size() - 1);
  }

  const std::vector<BinaryNode>& binary_;
  WideBvh& out_;
};

}  // namespace

WideBvh build_bvh(const std::vector<Box>& boxes, int max_leaf, TilePool& pool) {
  WideBvh bvh;
  if (boxes.empty()) return bvh;
  Builder builder(boxes, max_leaf);
  const std::vector<BinaryNode> binary = builder.build(pool);
  bvh.order = builder.take_order();
  bvh.bounds = binary[0].box;
  Collapser(binary, bvh).make(0, 1);
  return bvh;
}

}  // namespace tilelight
