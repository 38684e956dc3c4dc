// SPDX-License-Identifier: Apache-2.0
#include "renderer/geometry/self_touch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "renderer/base/facet.h"
#include "renderer/geometry/extent.h"

namespace tilelight {
namespace {

// Planes that are turned by more meet in a line: what is within rounding of both is too narrow to be seen.
constexpr double kParallel = 0x1p-16;

using Corners = std::array<Vec3, 3>;

// How far two facets reach over each other along an axis.
double overlap_along(const Vec3& axis, const Corners& a, const Corners& b) {
  const auto reach = [&](const Corners& corners) {
    const double x = glm::dot(axis, corners[0]), y = glm::dot(axis, corners[1]), z = glm::dot(axis, corners[2]);
    return std::pair(std::min({x, y, z}), std::max({x, y, z}));
  };
  const auto [a_low, a_high] = reach(a);
  const auto [b_low, b_high] = reach(b);
  return std::min(a_high, b_high) - std::max(a_low, b_low);
}

// The facets by halves, each half in a box.
class FacetTree {
 public:
  explicit FacetTree(const TriMesh& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
    Extent all;
    for (const Vec3& p : mesh.positions) all.grow(p);
    const Vec3 sides = all.hi - all.lo, farthest = glm::max(glm::abs(all.lo), glm::abs(all.hi));
    const double rounding = 0x1p-48 * std::max({farthest.x, farthest.y, farthest.z});
    const double size = std::max({sides.x, sides.y, sides.z});
    gap_ = 0x1p-20 * size + rounding, least_overlap_ = 0x1p-40 * size + rounding;
    std::iota(order_.begin(), order_.end(), 0u);
    for (uint32_t t = 0; t < order_.size(); ++t) {
      const Corners at = corners_of(t);
      normals_.push_back(geometric_normal(at[0], at[1], at[2]));
      middles_.push_back(at[0] / 3.0 + at[1] / 3.0 + at[2] / 3.0);
    }
    nodes_.reserve(2 * order_.size());
    if (!order_.empty()) build(0, static_cast<uint32_t>(order_.size()));
  }

  bool has_two_in_one_place() {
    std::vector<std::pair<uint32_t, uint32_t>> pairs;
    if (!nodes_.empty()) pairs.emplace_back(0, 0);
    for (size_t work = 0; !pairs.empty(); ++work) {
      if (work > kMostWork) return true;
      const auto [i, k] = pairs.back();
      pairs.pop_back();
      const Node &a = nodes_[i], &b = nodes_[k];
      if (i != k && !a.box.meets(b.box)) continue;
      if (a.is_leaf() && b.is_leaf()) {
        if (i != k && are_in_one_place(order_[a.first], order_[b.first])) return true;
      } else if (i == k) {
        pairs.insert(pairs.end(), {{i + 1, i + 1}, {a.second_child, a.second_child}, {i + 1, a.second_child}});
      } else if (b.is_leaf() || (!a.is_leaf() && a.count >= b.count)) {
        pairs.insert(pairs.end(), {{i + 1, k}, {a.second_child, k}});
      } else {
        pairs.insert(pairs.end(), {{i, k + 1}, {i, b.second_child}});
      }
    }
    return false;
  }

 private:
  static constexpr size_t kMostWork = 100'000'000;  // about a second

  // The first child follows its parent.
  struct Node {
    Extent box;
    uint32_t first, count, second_child = 0;
    bool is_leaf() const { return count == 1; }
  };

  Corners corners_of(uint32_t triangle) const {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    return {mesh_.positions[a], mesh_.positions[b], mesh_.positions[c]};
  }

  uint32_t build(uint32_t first, uint32_t count) {
    const auto index = static_cast<uint32_t>(nodes_.size());
    Extent box, middles;
    for (uint32_t i = first; i < first + count; ++i) {
      for (const Vec3& p : corners_of(order_[i])) box.grow(p);
      middles.grow(middles_[order_[i]]);
    }
    nodes_.push_back({box.widened(0.5 * gap_), first, count});
    if (count == 1) return index;
    const Vec3 sides = middles.hi - middles.lo;
    const int axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
    const uint32_t half = count / 2;
    const auto begin = order_.begin() + first;
    std::nth_element(begin, begin + half, begin + count,
                     [&](uint32_t a, uint32_t b) { return middles_[a][axis] < middles_[b][axis]; });
    build(first, half);
    const uint32_t second = build(first + half, count - half);
    nodes_[index].second_child = second;
    return index;
  }

  // By separating axes: across the plane, and in it across every edge. Neighbours in a smooth or flat surface have an
  // edge in common, across which they lie beside each other.
  bool are_in_one_place(uint32_t i, uint32_t k) const {
    const Vec3 &normal = normals_[i], across_both = glm::cross(normal, normals_[k]);
    if (!(glm::dot(across_both, across_both) < kParallel * kParallel)) return false;
    const Corners a = corners_of(i), b = corners_of(k);
    if (overlap_along(normal, a, b) < -gap_) return false;
    for (const Corners& of : {a, b}) {
      for (size_t c = 0; c < 3; ++c) {
        const Vec3 across = unit_or_zero(glm::cross(normal, of[(c + 1) % 3] - of[c]));
        if (!(overlap_along(across, a, b) > least_overlap_)) return false;
      }
    }
    return true;
  }

  const TriMesh& mesh_;
  std::vector<uint32_t> order_;
  std::vector<Vec3> normals_, middles_;  // by facet
  std::vector<Node> nodes_;
  double gap_ = 0.0, least_overlap_ = 0.0;
};

}  // namespace

bool touches_itself(const TriMesh& mesh) { return FacetTree(mesh).has_two_in_one_place(); }

}  // namespace tilelight
