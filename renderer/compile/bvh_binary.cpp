// SPDX-License-Identifier: Apache-2.0
#include "renderer/compile/bvh_binary.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <utility>

namespace tilelight {
namespace {

constexpr uint32_t kMostBins = 16;
// Under this depth the split falls back to halves by index, so a tree of 2^26 boxes is at most 66 levels deep, also
// where all of them are equal.
constexpr int kMaxSahDepth = 40;
// A leaf is split only if that takes this share of its cost away: small leaves cost memory, and nodes above them.
constexpr float kWorth = 0.5f;
constexpr uint32_t kChunk = 1 << 12;  // boxes that one thread takes at a time while all of them work together
// Boxes of a subtree that one thread splits. At least 32 of them keep the threads evenly busy.
constexpr uint32_t kLeastSubtree = 1 << 10, kSubtrees = 32;

using Range = WideBvh::Leaf;
using Int4 = int32_t __attribute__((vector_size(16)));

// A box and its index, which lies in the bits of the idle place.
class Item {
 public:
  Item() {}  // leaves it as it is: a vector of them is filled by all threads
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

// What items span.
struct Extent {
  Bounds bounds = Bounds::none(), middles = Bounds::none();  // middles: of all twice_middle()
  void grow(const Item& item) { bounds.grow(item.bounds()), middles.grow(item.twice_middle()); }
  void grow(const Extent& other) { bounds.grow(other.bounds), middles.grow(other.middles); }
};

Extent extent_of(std::span<const Item> items) {
  Extent out;
  for (const Item& item : items) out.grow(item);
  return out;
}

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
      if (is_flat[axis]) scale[axis] = 0.0f;
    }
    scale[3] = 0.0f;
  }
  bool is_all_flat() const { return is_flat[0] && is_flat[1] && is_flat[2]; }
  Float4 place_of(const Item& item) const { return (item.twice_middle() - lo) * scale; }
};

class Bins {
 public:
  explicit Bins(const Binning& binning) : binning_(binning) {
    for (auto& axis : bounds_) std::fill_n(axis.begin(), binning.count, Bounds::none());
  }
  void add(const Item& item) {
    const Int4 place = __builtin_convertvector(binning_.place_of(item), Int4);
    for (int axis = 0; axis < 3; ++axis) {
      const uint32_t bin = std::min(binning_.count - 1, static_cast<uint32_t>(place[axis]));
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

// Where a range is cut in two.
struct Split {
  int axis = -1;     // -1: by index, into halves
  uint32_t bin = 0;  // at which the right side begins
  float cost = Bounds::kFarOut;

  // An item's bin is its place cut off, so that it is below `bin` where the place is.
  bool is_left(const Binning& binning, const Item& item) const {
    return binning.place_of(item)[axis] < static_cast<float>(bin);
  }
};

// A range of the top that is to be split.
struct Open {
  Range range;
  Extent extent;
  int depth, place;  // place: of its node in the top
};
// One that a single thread splits.
struct Closed {
  Open open;
  int buffer;  // where its items lie
};
// What a thread takes of a level at a time: a part of a range, and what it finds in it.
struct Chunk {
  size_t open;  // into level_
  Range range;
  Bins bins;
  uint32_t left = 0;                   // items on the left side
  uint32_t left_to = 0, right_to = 0;  // where its sides go
  Extent sides[2] = {};                // what they span
};

class Builder {
 public:
  Builder(const BoxSource& boxes, int max_leaf, TilePool& pool)
      : pool_(pool), max_leaf_(static_cast<uint32_t>(max_leaf)), alone_from_(boxes.alone_from), count_(boxes.count) {
    for (auto& items : items_) items.resize(count_);
    tree_.order.resize(count_);
    subtree_size_ = std::max(count_ / kSubtrees, kLeastSubtree);
    tree_.top.emplace_back();
    Open root{{0, count_}, make_items(boxes), 0, 0};
    if (count_ <= subtree_size_) {
      close(root, 0);
    } else {
      level_.push_back(root);
    }
  }

  BinaryTree build() {
    for (int from = 0; !level_.empty(); from = 1 - from) split_level(from);
    tree_.subtrees.resize(closed_.size());
    pool_.parallel_for(static_cast<int64_t>(closed_.size()), Priority::normal, [&](int64_t i) {
      const Closed& job = closed_[static_cast<size_t>(i)];
      const std::span<Item> items(items_[job.buffer]);
      split(items, job.open.range, job.open.extent, job.open.depth, tree_.subtrees[static_cast<size_t>(i)]);
      for (uint32_t k = 0; k < job.open.range.count; ++k)
        tree_.order[job.open.range.first + k] = items[job.open.range.first + k].index();
    });
    return std::move(tree_);
  }

 private:
  template <class Work>
  void for_all(size_t count, const Work& work) {
    pool_.parallel_for(static_cast<int64_t>(count), Priority::normal, [&](int64_t i) { work(static_cast<size_t>(i)); });
  }

  Extent make_items(const BoxSource& boxes) {
    std::vector<Extent> parts((count_ + kChunk - 1) / kChunk);
    for_all(parts.size(), [&](size_t c) {
      const uint32_t first = static_cast<uint32_t>(c) * kChunk;
      for (uint32_t i = first; i < std::min(count_, first + kChunk); ++i) {
        items_[0][i] = Item(boxes.box_of(i), i);
        parts[c].grow(items_[0][i]);
      }
    });
    Extent out;
    for (const Extent& part : parts) out.grow(part);
    return out;
  }

  void close(const Open& open, int buffer) {
    tree_.top[static_cast<size_t>(open.place)].bounds = open.extent.bounds;
    tree_.top[static_cast<size_t>(open.place)].range = open.range;
    tree_.top[static_cast<size_t>(open.place)].subtree = static_cast<int>(closed_.size());
    closed_.push_back({open, buffer});
  }

  // Splits all ranges of a level, from the one buffer into the other. Which items are together in a chunk depends on
  // the ranges alone, and items keep their order.
  void split_level(int from) {
    std::vector<Binning> binnings;
    std::vector<Chunk> chunks;
    for (size_t i = 0; i < level_.size(); ++i) {
      const Range r = level_[i].range;
      binnings.emplace_back(level_[i].extent.middles, r.count);
      for (uint32_t first = r.first; first < r.first + r.count; first += kChunk)
        chunks.push_back(Chunk{i, Range{first, std::min(kChunk, r.first + r.count - first)}, Bins(binnings[i])});
    }
    const std::vector<Item>& items = items_[from];
    for_all(chunks.size(), [&](size_t c) {
      Chunk& chunk = chunks[c];
      for (uint32_t k = 0; k < chunk.range.count; ++k) chunk.bins.add(items[chunk.range.first + k]);
    });
    const std::vector<Split> splits = choose_splits(binnings, chunks);
    for_all(chunks.size(), [&](size_t c) {
      scatter(chunks[c], binnings[chunks[c].open], splits[chunks[c].open], items, items_[1 - from]);
    });
    open_next(chunks, 1 - from);
  }

  // The split of every range of the level, and where its chunks put their items.
  std::vector<Split> choose_splits(const std::vector<Binning>& binnings, std::vector<Chunk>& chunks) const {
    std::vector<Split> splits;
    auto chunk = chunks.begin();
    for (size_t i = 0; i < level_.size(); ++i) {
      const Range r = level_[i].range;
      Bins all(binnings[i]);
      const auto first = chunk;
      for (; chunk != chunks.end() && chunk->open == i; ++chunk) all.grow(chunk->bins);
      const Split split = choose_split(binnings[i], all, level_[i].depth);
      uint32_t left = 0;
      for (auto c = first; c != chunk; ++c) left += c->left = left_of(*c, split, r);
      uint32_t left_to = r.first, right_to = r.first + left;
      for (auto c = first; c != chunk; ++c) {
        c->left_to = left_to, c->right_to = right_to;
        left_to += c->left, right_to += c->range.count - c->left;
      }
      splits.push_back(split);
    }
    return splits;
  }

  static uint32_t left_of(const Chunk& chunk, const Split& split, Range whole) {
    if (split.axis < 0) {
      const uint32_t middle = whole.first + whole.count / 2;
      return middle <= chunk.range.first ? 0 : std::min(chunk.range.count, middle - chunk.range.first);
    }
    uint32_t left = 0;
    for (uint32_t b = 0; b < split.bin; ++b) left += chunk.bins.count(static_cast<size_t>(split.axis), b);
    return left;
  }

  static void scatter(Chunk& chunk, const Binning& binning, const Split& split, const std::vector<Item>& from,
                      std::vector<Item>& to) {
    uint32_t place[2] = {chunk.right_to, chunk.left_to};
    for (uint32_t k = 0; k < chunk.range.count; ++k) {
      const Item& item = from[chunk.range.first + k];
      const bool is_left = split.axis < 0 ? k < chunk.left : split.is_left(binning, item);
      to[place[is_left]++] = item;
    }
    const std::span<const Item> items(to);
    chunk.sides[0] = extent_of(items.subspan(chunk.left_to, chunk.left));
    chunk.sides[1] = extent_of(items.subspan(chunk.right_to, chunk.range.count - chunk.left));
  }

  // Makes the sides of all splits the next level.
  void open_next(const std::vector<Chunk>& chunks, int buffer) {
    std::vector<Open> next;
    auto chunk = chunks.begin();
    for (size_t i = 0; i < level_.size(); ++i) {
      const Open& open = level_[i];
      Extent sides[2];
      uint32_t left = 0;
      for (; chunk != chunks.end() && chunk->open == i; ++chunk) {
        for (int side = 0; side < 2; ++side) sides[side].grow(chunk->sides[side]);
        left += chunk->left;
      }
      const Range ranges[2] = {{open.range.first, left}, {open.range.first + left, open.range.count - left}};
      const int first = static_cast<int>(tree_.top.size());
      BinaryNode& node = tree_.top[static_cast<size_t>(open.place)];
      node.bounds = open.extent.bounds, node.range = open.range, node.left = first, node.right = first + 1;
      for (int side = 0; side < 2; ++side) {
        tree_.top.emplace_back();
        const Open child{ranges[side], sides[side], open.depth + 1, first + side};
        if (child.range.count <= subtree_size_) {
          close(child, buffer);
        } else {
          next.push_back(child);
        }
      }
    }
    level_ = std::move(next);
  }

  // By one thread, all the way down. Returns the place of the range's node.
  int split(std::span<Item> items, Range r, const Extent& extent, int depth, std::vector<BinaryNode>& nodes) const {
    const auto me = nodes.size();
    nodes.push_back({extent.bounds, r});
    if (r.count <= 1) return static_cast<int>(me);
    const Binning binning(extent.middles, r.count);
    Bins bins(binning);
    for (const Item& item : items.subspan(r.first, r.count)) bins.add(item);
    const Split best = choose_split(binning, bins, depth);
    if (fits(items, r) && !(best.cost < kWorth * extent.bounds.half_area())) return static_cast<int>(me);
    const uint32_t mid = divide(items.subspan(r.first, r.count), binning, best);
    const Range a{r.first, mid}, b{r.first + mid, r.count - mid};
    const int left = split(items, a, extent_of(items.subspan(a.first, a.count)), depth + 1, nodes);
    const int right = split(items, b, extent_of(items.subspan(b.first, b.count)), depth + 1, nodes);
    nodes[me].left = left, nodes[me].right = right;
    return static_cast<int>(me);
  }

  bool fits(std::span<const Item> items, Range r) const {
    if (r.count > max_leaf_) return false;
    for (const Item& item : items.subspan(r.first, r.count))
      if (item.index() >= alone_from_) return false;
    return true;
  }

  // Reorders the items and returns how many are on the left. Without a branch: nothing could predict it.
  static uint32_t divide(std::span<Item> items, const Binning& binning, const Split& split) {
    if (split.axis < 0) return static_cast<uint32_t>(items.size() / 2);
    size_t left = 0;
    for (Item& place : items) {
      const Item item = place;
      place = items[left];
      items[left] = item;
      left += split.is_left(binning, item);
    }
    return static_cast<uint32_t>(left);
  }

  Split choose_split(const Binning& binning, const Bins& bins, int depth) const {
    if (depth >= kMaxSahDepth || binning.is_all_flat()) return {};
    Split best;
    for (size_t axis = 0; axis < 3; ++axis) {
      if (binning.is_flat[axis]) continue;
      std::array<float, kMostBins> right_cost;
      Bounds box = Bounds::none();
      uint32_t count = 0;
      for (uint32_t b = binning.count - 1; b > 0; --b) {
        box.grow(bins.bounds(axis, b));
        count += bins.count(axis, b);
        right_cost[b] = count == 0 ? Bounds::kFarOut : box.half_area() * blocks_of(count);
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
  const uint32_t max_leaf_, alone_from_, count_;
  uint32_t subtree_size_ = 0;
  std::vector<Item> items_[2];
  std::vector<Open> level_;
  std::vector<Closed> closed_;
  BinaryTree tree_;
};

}  // namespace

float round_down(double x) {
  const float f = static_cast<float>(x);
  return f <= x ? f : std::nextafterf(f, -Bounds::kFarOut);
}

float round_up(double x) {
  const float f = static_cast<float>(x);
  return f >= x ? f : std::nextafterf(f, Bounds::kFarOut);
}

BinaryTree build_binary_tree(const BoxSource& boxes, int max_leaf, TilePool& pool) {
  return Builder(boxes, max_leaf, pool).build();
}

}  // namespace tilelight
