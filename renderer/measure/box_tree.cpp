// SPDX-License-Identifier: Apache-2.0
#include "renderer/measure/box_tree.h"

#include <numeric>

namespace tilelight::reference {

BoxTree::BoxTree(const std::vector<Box>& boxes) : order_(boxes.size()) {
  if (boxes.empty()) return;
  std::iota(order_.begin(), order_.end(), 0u);
  nodes_.reserve(boxes.size());
  build(boxes, 0, static_cast<uint32_t>(boxes.size()));
}

void BoxTree::build(const std::vector<Box>& boxes, uint32_t begin, uint32_t end) {
  const size_t self = nodes_.size();
  nodes_.emplace_back();
  Box all, centres;
  for (uint32_t i = begin; i < end; ++i) {
    const Box& box = boxes[order_[i]];
    all.include(box);
    centres.include(0.5 * (box.lo + box.hi));
  }
  nodes_[self].box = all;
  if (end - begin <= kLeafSize) {
    nodes_[self].first = begin;
    nodes_[self].count = static_cast<uint16_t>(end - begin);
    return;
  }
  const Vec3 size = centres.hi - centres.lo;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](uint32_t a, uint32_t b) {
    return boxes[a].lo[axis] + boxes[a].hi[axis] < boxes[b].lo[axis] + boxes[b].hi[axis];
  });
  nodes_[self].axis = static_cast<uint16_t>(axis);
  build(boxes, begin, middle);
  nodes_[self].first = static_cast<uint32_t>(nodes_.size());
  build(boxes, middle, end);
}

}  // namespace tilelight::reference
