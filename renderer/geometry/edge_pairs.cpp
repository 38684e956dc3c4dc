// SPDX-License-Identifier: Apache-2.0
#include "renderer/geometry/edge_pairs.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "renderer/base/facet.h"

namespace tilelight {
namespace {

// A whole number that grows with the angle, from the x axis on; what differs by rounding has the same.
int64_t turn_of(double x, double y) {
  constexpr double kQuarter = 0x1p30;
  const double size = std::abs(x) + std::abs(y);
  if (!(size > 0.0)) return 0;
  const double part = y / size, turn = x < 0.0 ? 2.0 - part : y < 0.0 ? 4.0 + part : part;
  return std::llround(turn * kQuarter) % static_cast<int64_t>(4.0 * kQuarter);
}

void sort_by_turn(const Vec3& edge, std::vector<EdgeUse>& uses) {
  const Vec3 axis = unit_or_zero(edge);
  const auto flat = [&](const EdgeUse& use) {
    const Vec3 way = unit_or_zero(use.across);
    return unit_or_zero(way - glm::dot(way, axis) * axis);
  };
  const Vec3 x = flat(uses[0]), y = glm::cross(axis, x);
  // In one place: what ends before what begins, and copies from the inside of their normal to its outside.
  const auto key = [&](const EdgeUse& use) {
    const Vec3 at = flat(use);
    const int64_t height = use.is_upward ? int64_t{use.copy} : -int64_t{use.copy};
    return std::tuple(turn_of(glm::dot(at, x), glm::dot(at, y)), !use.is_upward, height, use.facet);
  };
  std::sort(uses.begin(), uses.end(), [&](const EdgeUse& a, const EdgeUse& b) { return key(a) < key(b); });
}

}  // namespace

std::vector<std::pair<uint32_t, uint32_t>> pair_uses(const Vec3& edge, std::vector<EdgeUse> uses) {
  sort_by_turn(edge, uses);
  std::vector<std::pair<uint32_t, uint32_t>> pairs;
  std::vector<uint32_t> begun;
  std::vector<EdgeUse> unbegun;  // ends of what begins later, in the turn before
  const auto end = [&](const EdgeUse& use) {
    pairs.emplace_back(begun.back(), use.facet);
    begun.pop_back();
  };
  for (const EdgeUse& use : uses) {
    if (!use.is_upward) {
      begun.push_back(use.facet);
    } else if (begun.empty()) {
      unbegun.push_back(use);
    } else {
      end(use);
    }
  }
  for (const EdgeUse& use : unbegun) end(use);
  return pairs;
}

}  // namespace tilelight
