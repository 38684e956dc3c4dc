// SPDX-License-Identifier: Apache-2.0
// Pairs of boxes that meet, one of each list: both lists are cut down to where they meet, the longer one is halved at
// its median, and so on. Deterministic. Pure; any thread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "renderer/compile/bvh.h"

namespace tilelight::lines {

struct NamedBox {
  Box box;
  uint32_t name;
};

inline bool do_meet(const Box& a, const Box& b) {
  for (int k = 0; k < 3; ++k)
    if (!(a.lo[k] <= b.hi[k] && b.lo[k] <= a.hi[k])) return false;
  return true;
}

inline Box bounds_of(const std::vector<NamedBox>& boxes) {
  Box all;
  for (const NamedBox& b : boxes) all.grow(b.box);
  return all;
}

// visit(name of a, name of b), each pair once.
template <class Visit>
void visit_close_pairs(std::vector<NamedBox> a, std::vector<NamedBox> b, const Visit& visit) {
  constexpr size_t kFewPairs = 256;
  const Box a_bounds = bounds_of(a), b_bounds = bounds_of(b);
  std::erase_if(a, [&](const NamedBox& box) { return !do_meet(box.box, b_bounds); });
  std::erase_if(b, [&](const NamedBox& box) { return !do_meet(box.box, a_bounds); });
  if (a.size() * b.size() <= kFewPairs) {
    for (const NamedBox& one : a)
      for (const NamedBox& other : b)
        if (do_meet(one.box, other.box)) visit(one.name, other.name);
    return;
  }
  const bool halves_a = a.size() >= b.size();
  std::vector<NamedBox>& longer = halves_a ? a : b;
  const Box bounds = bounds_of(longer);
  const Vec3 size = bounds.hi - bounds.lo;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto middle = longer.begin() + static_cast<std::ptrdiff_t>(longer.size() / 2);
  std::nth_element(longer.begin(), middle, longer.end(), [axis](const NamedBox& p, const NamedBox& q) {
    const double at_p = p.box.lo[axis] + p.box.hi[axis], at_q = q.box.lo[axis] + q.box.hi[axis];
    return at_p != at_q ? at_p < at_q : p.name < q.name;
  });
  const std::vector<NamedBox> low(longer.begin(), middle), high(middle, longer.end());
  for (const auto& half : {low, high}) {
    if (halves_a)
      visit_close_pairs(half, b, visit);
    else
      visit_close_pairs(a, half, visit);
  }
}

}  // namespace tilelight::lines
