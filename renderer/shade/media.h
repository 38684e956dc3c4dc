// SPDX-License-Identifier: Apache-2.0
// MediaSet: the transparent bodies a ray is inside of, in the order of entering. The medium that counts is the one of
// the highest priority, among equals the one entered last (after Schmidt and Budge 2002). Plain value.
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
    if (count_ < kCapacity) bodies_[count_++] = body;
  }
  // Takes the last entry of the body away.
  void leave(uint32_t body) {
    int last = count_ - 1;
    while (last >= 0 && bodies_[last] != body) --last;
    if (last < 0) return;
    for (int i = last; i + 1 < count_; ++i) bodies_[i] = bodies_[i + 1];
    --count_;
  }
  bool contains(uint32_t body) const {
    for (int i = 0; i < count_; ++i) {
      if (bodies_[i] == body) return true;
    }
    return false;
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

// The media on both sides of a medium's surface, as a ray meets it.
struct Crossing {
  MediaSet before, after;
  bool is_seen = true;  // false where another medium fills the inner side: the surface is passed unbent

  Crossing(const CompiledScene& scene, const MediaSet& media, uint32_t body, bool from_outside)
      : before(media), after(media) {
    MediaSet& inner = from_outside ? after : before;
    // A body that is left without having been entered counts as entered.
    if (from_outside || !inner.contains(body)) inner.enter(body);
    is_seen = inner.top(scene) == body;
    if (from_outside) return;
    after = before;
    after.leave(body);
  }
};

}  // namespace tilelight
