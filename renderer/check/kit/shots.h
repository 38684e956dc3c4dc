// SPDX-License-Identifier: Apache-2.0
// Shots: many random rays on all threads, and what is counted of them. The same on any number of threads.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "renderer/check/kit/rays.h"

namespace tilelight::check {

struct Tally {
  int64_t wrong = 0, also_wrong = 0, naive_wrong = 0;  // rays
  double worst = 0.0, naive_worst = 0.0;               // what `note` kept

  Tally& operator+=(const Tally& other) {
    wrong += other.wrong, also_wrong += other.also_wrong, naive_wrong += other.naive_wrong;
    worst = std::max(worst, other.worst), naive_worst = std::max(naive_worst, other.naive_worst);
    return *this;
  }
};
// Calls shoot(random, tally) `count` times.
template <class Shoot>
Tally tally_shots(TilePool& pool, int64_t count, uint64_t seed, const Shoot& shoot) {
  constexpr int64_t kBlock = 2048;
  std::vector<Tally> blocks(static_cast<size_t>((count + kBlock - 1) / kBlock));
  pool.parallel_for(static_cast<int64_t>(blocks.size()), Priority::batch, [&](int64_t block) {
    Random random(seed << 32 | static_cast<uint64_t>(block));
    for (int64_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i)
      shoot(random, blocks[static_cast<size_t>(block)]);
  });
  Tally sum;
  for (const Tally& block : blocks) sum += block;
  return sum;
}

// A unit vector across a unit vector.
inline Vec3 across(const Vec3& direction, Random& random) {
  while (true) {
    const Vec3 side = glm::cross(direction, random.direction());
    if (const double length = glm::length(side); length > 0.1) return side / length;
  }
}

// A scene of shapes, for numbers that a text would round.
inline Scene scene_of_shapes(const std::vector<Shape>& shapes) {
  Scene scene;
  scene.materials.resize(1);
  for (const Shape& shape : shapes) scene.objects.emplace_back().shape = shape;
  return scene;
}

}  // namespace tilelight::check
