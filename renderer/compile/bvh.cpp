// SPDX-License-Identifier: Apache-2.0
#include "renderer/compile/bvh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace tilelight {
namespace {

constexpr uint32_t kMostBins = 16;
// Under this depth the split falls back to halves by index, so the tree never gets deeper than about 64 levels, also
// for a hundred thousand equal boxes.
constexpr int kMaxSahDepth = 40;
// A leaf is split only if that takes this share of its cost away: small leaves cost memory, and nodes above them.
constexpr float kWorth = 0.5f;
// Boxes. Larger ranges are split by all threads together, a chunk at a time; smaller ones each by one thread.
constexpr uint32_t kTogetherMin = 1 << 15, kChunk = 1 << 13;

// Four floats that a compiler keeps in one register (GCC's and Clang's vector extension); the last is idle.
using Float4 = float __attribute__((vector_size(16)));

Float4 min_of(Float4 a, Float4 b) { return a < b ? a : b; }
Float4 max_of(Float4 a, Float4 b) { return a > b ? a : b; }

constexpr float kFarOut = std::numeric_limits<float>::infinity();

struct Bounds {
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

float round_down(double x) {
  const float f = static_cast<float>(x);
  return f <= x ? f : std::nextafterf(f, -kFarOut);
}
float round_up(double x) {
  const float f = static_cast<float>(x);
  return f >= x ? f : std::nextafterf(f, kFarOut);
}

// A box and its index, which lies in the bits of the idle place.
class Item {
 public:
  Item() = default;
  Item(const Box& box, uint32_t index) {
    for (int axis = 0; axis < 3; ++axis)
      bounds_.lo[axis] = round_down(box.lo[axis]), bounds_.hi[axis] = round_up(box.hi[axis]);
    bounds_.lo[3] = std::bit_cast<float>(index + kOne);
    bounds_.hi[3] = 0.0f;
  }
  const Bounds& bounds() const { return bounds_; }
  Float4 twice_middle() const { return bounds_.lo + bounds_.hi; }
  uint32_t index() const { return std::bit_cast<uint32_t>(static_cast<float>(bounds_.lo[3])) - kOne; }

 private:
  static constexpr uint32_t kOne =
      0x3F80'0000;  // the bits of 1.0: numbers near 0 would slow the arithmetic beside them
  Bounds bounds_;
};

struct Range {
  uint32_t first = 0, count = 0;
  uint32_t end() const { return first + count; }
};

struct BinaryNode {
  Bounds bounds;
  Range range;
  int left = -1, right = -1;  // -1: a leaf
};

// What the items of a range span.
struct Extent {
  Bounds bounds = Bounds::none(), middles = Bounds::none();  // middles: of all twice_middle()
  bool has_alone = false;
  void grow(const Extent& other) {
    bounds.grow(other.bounds), middles.grow(other.middles);
    has_alone |= other.has_alone;
  }
};

// Bins by an item's middle, along every axis.
struct Binning {
  uint32_t count;  // of bins
  Float4 lo, scale;
  bool is_flat[3];  // all middles agree

  Binning(const Bounds& middles, uint32_t items) : count(std::min(kMostBins, items / 4 + 4)), lo(middles.lo) {
    for (int axis = 0; axis < 3; ++axis) {
      const float extent = middles.hi[axis] - middles.lo[axis];
      scale[axis] = static_cast<float>(count) / extent;
      is_flat[axis] = !(extent > 0.0f) || !std::isfinite(scale[axis]);
    }
    scale[3] = 0.0f;
  }
  uint32_t bin_of(float place) const { return std::min(count - 1, static_cast<uint32_t>(place)); }
  uint32_t bin_of(const Item& item, int axis) const {
    return bin_of((item.twice_middle()[axis] - lo[axis]) * scale[axis]);
  }
};

class Bins {
 public:
  explicit Bins(const Binning& binning) : binning_(binning) {
    for (auto& axis : bounds_) std::fill_n(axis.begin(), binning.count, Bounds::none());
  }
  void add(const Item& item) {
    const Float4 place = (item.twice_middle() - binning_.lo) * binning_.scale;
    for (size_t axis = 0; axis < 3; ++axis) {
      if (binning_.is_flat[axis]) continue;
      const uint32_t bin = binning_.bin_of(place[axis]);
      bounds_[axis][bin].grow(item.bounds());
      ++counts_[axis][bin];
    }
  }
  void grow(const Bins& other) {
    for (size_t axis = 0; axis < 3; ++axis) {
      for (size_t b = 0; b < binning_.count; ++b) {
        bounds_[axis][b].grow(other.bounds_[axis][b]);
        counts_[axis][b] += other.counts_[axis][b];
      }
    }
  }
  const Bounds& bounds(size_t axis, size_t bin) const { return bounds_[axis][bin]; }
  uint32_t count(size_t axis, size_t bin) const { return counts_[axis][bin]; }

 private:
  const Binning binning_;
  std::array<std::array<Bounds, kMostBins>, 3> bounds_;
  std::array<std::array<uint32_t, kMostBins>, 3> counts_{};
};

struct Split {
  int axis = -1;     // -1: none
  uint32_t bin = 0;  // at which the right side begins
  float cost = kFarOut;
};

class Builder {
 public:
  Builder(const BoxSource& boxes, int max_leaf, TilePool& pool)
      : pool_(pool), max_leaf_(static_cast<uint32_t>(max_leaf)), alone_from_(boxes.alone_from), items_(boxes.count) {
    in_chunks({0, boxes.count}, [&](size_t, Range r) {
      for (uint32_t i = r.first; i < r.end(); ++i) items_[i] = Item(boxes.box_of(i), i);
    });
  }

  std::vector<BinaryNode> build() {
    std::vector<BinaryNode> top;
    const Range all{0, static_cast<uint32_t>(items_.size())};
    split_top(all, extent_together(all), 0, std::max<uint32_t>(all.count / 32, 1024), top);
    pool_.parallel_for(static_cast<int64_t>(jobs_.size()), Priority::normal, [&](int64_t i) {
      Job& job = jobs_[static_cast<size_t>(i)];
      split(job.range, extent_of(job.range), job.depth, job.nodes);
    });
    for (const Job& job : jobs_) graft(top, job);
    return top;
  }

  std::vector<uint32_t> order() const {
    std::vector<uint32_t> order;
    order.reserve(items_.size());
    for (const Item& item : items_) order.push_back(item.index());
    return order;
  }

 private:
  // A subtree whose split is still to be done.
  struct Job {
    Range range;
    int depth, place;               // place: of its root in the top
    std::vector<BinaryNode> nodes;  // the finished subtree, [0] its root
  };

  // work(chunk, range) for every chunk of a range, on all threads if it is large.
  template <class Work>
  void in_chunks(Range r, const Work& work) {
    const uint32_t chunks = (r.count + kChunk - 1) / kChunk;
    const auto one = [&](int64_t c) {
      const uint32_t first = r.first + static_cast<uint32_t>(c) * kChunk;
      work(static_cast<size_t>(c), Range{first, std::min(kChunk, r.end() - first)});
    };
    if (r.count >= kTogetherMin) {
      pool_.parallel_for(chunks, Priority::normal, one);
    } else {
      for (uint32_t c = 0; c < chunks; ++c) one(c);
    }
  }

  Extent extent_of(Range r) const {
    Extent out;
    for (uint32_t i = r.first; i < r.end(); ++i) {
      out.bounds.grow(items_[i].bounds());
      out.middles.grow(items_[i].twice_middle());
      out.has_alone |= items_[i].index() >= alone_from_;
    }
    return out;
  }
  Extent extent_together(Range r) {
    std::vector<Extent> parts((r.count + kChunk - 1) / kChunk);
    in_chunks(r, [&](size_t c, Range part) { parts[c] = extent_of(part); });
    Extent out;
    for (const Extent& part : parts) out.grow(part);
    return out;
  }

  void add_all(Range r, Bins& bins) const {
    for (uint32_t i = r.first; i < r.end(); ++i) bins.add(items_[i]);
  }
  Bins bins_of(Range r, const Binning& binning) const {
    Bins bins(binning);
    add_all(r, bins);
    return bins;
  }
  Bins bins_together(Range r, const Binning& binning) {
    std::vector<Bins> parts((r.count + kChunk - 1) / kChunk, Bins(binning));
    in_chunks(r, [&](size_t c, Range part) { add_all(part, parts[c]); });
    Bins out(binning);
    for (const Bins& part : parts) out.grow(part);
    return out;
  }

  // Splits until subtrees are small enough to be jobs of their own.
  int split_top(Range r, const Extent& extent, int depth, uint32_t job_size, std::vector<BinaryNode>& nodes) {
    const int me = static_cast<int>(nodes.size());
    nodes.push_back({extent.bounds, r});
    if (r.count <= job_size) {
      jobs_.push_back({r, depth, me, {}});
      return me;
    }
    const Binning binning(extent.middles, r.count);
    const Split best = is_by_index(binning, depth) ? Split{} : best_split(bins_together(r, binning), binning);
    const uint32_t mid = best.axis < 0 ? r.count / 2 : divide_together(r, binning, best);
    const Range a{r.first, mid}, b{r.first + mid, r.count - mid};
    const int left = split_top(a, extent_together(a), depth + 1, job_size, nodes);
    const int right = split_top(b, extent_together(b), depth + 1, job_size, nodes);
    nodes[me].left = left, nodes[me].right = right;
    return me;
  }

  int split(Range r, const Extent& extent, int depth, std::vector<BinaryNode>& nodes) {
    const int me = static_cast<int>(nodes.size());
    nodes.push_back({extent.bounds, r});
    if (r.count <= 1) return me;
    const bool fits = r.count <= max_leaf_ && !extent.has_alone;
    const Binning binning(extent.middles, r.count);
    const Split best = is_by_index(binning, depth) ? Split{} : best_split(bins_of(r, binning), binning);
    if (fits && !(best.cost < kWorth * extent.bounds.half_area())) return me;
    const uint32_t mid = best.axis < 0 ? r.count / 2 : divide(r, binning, best);
    const Range a{r.first, mid}, b{r.first + mid, r.count - mid};
    const int left = split(a, extent_of(a), depth + 1, nodes);
    const int right = split(b, extent_of(b), depth + 1, nodes);
    nodes[me].left = left, nodes[me].right = right;
    return me;
  }

  static bool is_by_index(const Binning& binning, int depth) {
    return depth >= kMaxSahDepth || (binning.is_flat[0] && binning.is_flat[1] && binning.is_flat[2]);
  }

  void graft(std::vector<BinaryNode>& top, const Job& job) {
    const int base = static_cast<int>(top.size()) - 1;  // node i lands at base + i for i >= 1, the root at its place
    for (size_t i = 0; i < job.nodes.size(); ++i) {
      BinaryNode n = job.nodes[i];
      if (n.left >= 0) n.left += base, n.right += base;
      if (i == 0) {
        top[static_cast<size_t>(job.place)] = n;
      } else {
        top.push_back(n);
      }
    }
  }

  // Reorders the range and returns the size of its left part.
  uint32_t divide(Range r, const Binning& binning, const Split& split) {
    Item* first = items_.data() + r.first;
    Item* mid = std::partition(first, first + r.count,
                               [&](const Item& item) { return binning.bin_of(item, split.axis) < split.bin; });
    return static_cast<uint32_t>(mid - first);
  }
  // The order depends on the chunks, which depend on the range alone.
  uint32_t divide_together(Range r, const Binning& binning, const Split& split) {
    const size_t chunks = (r.count + kChunk - 1) / kChunk;
    std::vector<uint32_t> left(chunks + 1), right(chunks + 1);
    in_chunks(r, [&](size_t c, Range part) {
      left[c + 1] = divide(part, binning, split);
      right[c + 1] = part.count - left[c + 1];
    });
    for (size_t c = 0; c < chunks; ++c) left[c + 1] += left[c], right[c + 1] += right[c];
    const uint32_t mid = left[chunks];
    other_.resize(items_.size());
    in_chunks(r, [&](size_t c, Range part) {
      const Item* from = items_.data() + part.first;
      const uint32_t here = left[c + 1] - left[c];
      std::copy_n(from, here, other_.data() + r.first + left[c]);
      std::copy_n(from + here, part.count - here, other_.data() + r.first + mid + right[c]);
    });
    in_chunks(r, [&](size_t, Range part) {
      std::copy_n(other_.data() + part.first, part.count, items_.data() + part.first);
    });
    return mid;
  }

  Split best_split(const Bins& bins, const Binning& binning) const {
    Split best;
    for (size_t axis = 0; axis < 3; ++axis) {
      if (binning.is_flat[axis]) continue;
      std::array<float, kMostBins> right_cost;
      Bounds box = Bounds::none();
      uint32_t count = 0;
      for (uint32_t b = binning.count - 1; b > 0; --b) {
        box.grow(bins.bounds(axis, b));
        count += bins.count(axis, b);
        right_cost[b] = count == 0 ? kFarOut : box.half_area() * blocks_of(count);
      }
      box = Bounds::none();
      count = 0;
      for (uint32_t b = 1; b < binning.count; ++b) {
        box.grow(bins.bounds(axis, b - 1));
        count += bins.count(axis, b - 1);
        if (count == 0) continue;
        const float cost = box.half_area() * blocks_of(count) + right_cost[b];
        if (cost < best.cost) best = {static_cast<int>(axis), b, cost};
      }
    }
    return best;
  }

  // A leaf is tested a block of max_leaf boxes at a time, so cost goes by blocks.
  float blocks_of(uint32_t count) const { return static_cast<float>((count + max_leaf_ - 1) / max_leaf_); }

  TilePool& pool_;
  const uint32_t max_leaf_, alone_from_;
  std::vector<Item> items_, other_;
  std::vector<Job> jobs_;
};

class Collapser {
 public:
  Collapser(const std::vector<BinaryNode>& binary, WideBvh& out) : binary_(binary), out_(out) {}

  uint32_t make(int root, int depth) {
    out_.depth = std::max(out_.depth, depth);
    const auto index = static_cast<uint32_t>(out_.nodes.size());
    out_.nodes.emplace_back();
    std::array<int, WideBvh::kWidth> children;
    const int count = open(root, children);
    std::array<uint32_t, WideBvh::kWidth> refs{};
    for (int i = 0; i < WideBvh::kWidth; ++i) refs[i] = i < count ? reference(children[i], depth) : WideBvh::kEmpty;
    WideBvh::Node& node = out_.nodes[index];
    for (int i = 0; i < WideBvh::kWidth; ++i) {
      node.child[i] = refs[i];
      for (int axis = 0; axis < 3; ++axis) {
        const bool used = i < count;
        node.bounds[0][axis][i] =
            used ? round_down(double{binary_[children[i]].bounds.lo[axis]} - WideBvh::kWiden) : WideBvh::kNowhere;
        node.bounds[1][axis][i] =
            used ? round_up(double{binary_[children[i]].bounds.hi[axis]} + WideBvh::kWiden) : -WideBvh::kNowhere;
      }
    }
    return index;
  }

 private:
  // Opens the largest inner child until there are eight. Returns how many there are.
  int open(int root, std::array<int, WideBvh::kWidth>& children) const {
    children[0] = root;
    int count = 1;
    while (count < WideBvh::kWidth) {
      int widest = -1;
      for (int i = 0; i < count; ++i) {
        if (binary_[children[i]].left < 0) continue;
        if (widest < 0 || binary_[children[i]].bounds.half_area() > binary_[children[widest]].bounds.half_area())
          widest = i;
      }
      if (widest < 0) break;
      const BinaryNode& opened = binary_[children[widest]];
      children[count++] = opened.right;
      children[widest] = opened.left;
    }
    return count;
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

WideBvh build_bvh(const BoxSource& boxes, int max_leaf, TilePool& pool) {
  WideBvh bvh;
  if (boxes.count == 0) return bvh;
  Builder builder(boxes, max_leaf, pool);
  const std::vector<BinaryNode> binary = builder.build();
  bvh.order = builder.order();
  Collapser(binary, bvh).make(0, 1);
  return bvh;
}

}  // namespace tilelight
