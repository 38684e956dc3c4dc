// SPDX-License-Identifier: Apache-2.0
// MediaSet: the transparent bodies a ray is inside of, in the order of entering. The medium that counts is the one of
// the highest priority, among equals the one entered last (after Schmidt and Budge 2002); a surface between equal media
// is passed unseen. Plain value.
#pragma once

#include <array>
#include <cstdint>

#include "renderer/compile/compiled_scene.h"
#include "renderer/shade/ray.h"

namespace tilelight {

class MediaSet {
 public:
  static constexpr int kCapacity = 16;  // deeper nesting keeps the first sixteen

  void enter(uint32_t body) {
    leave(body);
    if (count_ < kCapacity) bodies_[count_++] = body;
  }
  void leave(uint32_t body) {
    int kept = 0;
    for (int i = 0; i < count_; ++i) {
      if (bodies_[i] != body) bodies_[kept++] = bodies_[i];
    }
    count_ = kept;
  }
  // The body whose medium counts; kNone: the open air.
  uint32_t top(const CompiledScene& scene) const {
    uint32_t best = kNone;
    for (int i = 0; i < count_; ++i) {
      if (best == kNone || priority(scene, bodies_[i]) >= priority(scene, best)) best = bodies_[i];
    }
    return best;
  }
  double ior(const CompiledScene& scene) const {
    const uint32_t body = top(scene);
    return body == kNone ? 1.0 : scene.materials[scene.bodies[body].material].source.ior;
  }

 private:
  static int priority(const CompiledScene& scene, uint32_t body) {
    return scene.materials[scene.bodies[body].material].source.priority;
  }
  std::array<uint32_t, kCapacity> bodies_{};
  int count_ = 0;
};

}  // namespace tilelight
