// SPDX-License-Identifier: Apache-2.0
// Of many facets around one edge, which bound one piece of material between them. Pure; any thread.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "renderer/base/vec.h"

namespace tilelight {

// A facet's use of an edge, which leads from a low to a high corner.
struct EdgeUse {
  Vec3 across{0.0};  // the way from the edge to the facet's third corner, of any length
  uint32_t facet = 0;
  bool is_upward = false;  // from the low corner to the high one: the outer side is the one that a turn comes to last
  uint32_t copy = 0;       // a number for each of the facets with the same corners that are wound the same way
};

// Every use with one that goes the other way. In a turn about the edge material begins at the one and ends at the
// other, as brackets do. Copies of a facet lie on each other along its normal, in one order at all its edges.
// REQUIRES: as many uses one way as the other.
std::vector<std::pair<uint32_t, uint32_t>> pair_uses(const Vec3& edge, std::vector<EdgeUse> uses);

}  // namespace tilelight
