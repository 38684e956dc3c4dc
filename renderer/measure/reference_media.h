// SPDX-License-Identifier: Apache-2.0
// MediaStack: the media a ray is in. Where media overlap the one of the highest priority is there and the others are
// not (Schmidt and Budge 2002, Journal of Graphics Tools 7(4)); of equal priorities the one entered last.
#pragma once

#include <algorithm>
#include <vector>

#include "renderer/measure/reference_scene.h"

namespace tilelight::reference {

class MediaStack {
 public:
  MediaStack() = default;
  explicit MediaStack(std::vector<uint32_t> outermost_first) : bodies_(std::move(outermost_first)) {}

  // The index of refraction of what is there; 1 outside all media.
  double ior(const ReferenceScene& scene) const {
    const Material* top = nullptr;
    for (const uint32_t id : bodies_) {
      const Material& m = scene.material(id);
      if (!top || m.priority >= top->priority) top = &m;
    }
    return top ? top->ior : 1.0;
  }

  // Whether the surface of medium `body_id` lies inside another medium of higher priority, so that it is not there.
  bool hides(const ReferenceScene& scene, uint32_t body_id) const {
    const int priority = scene.material(body_id).priority;
    return std::any_of(bodies_.begin(), bodies_.end(),
                       [&](uint32_t id) { return id != body_id && scene.material(id).priority > priority; });
  }

  bool contains(uint32_t body_id) const { return std::find(bodies_.begin(), bodies_.end(), body_id) != bodies_.end(); }

  MediaStack with(uint32_t body_id) const {
    MediaStack result = *this;
    result.bodies_.push_back(body_id);
    return result;
  }

  // Without the last entry of `body_id`; unchanged if it is not there.
  MediaStack without(uint32_t body_id) const {
    MediaStack result = *this;
    const auto last = std::find(result.bodies_.rbegin(), result.bodies_.rend(), body_id);
    if (last != result.bodies_.rend()) result.bodies_.erase(std::next(last).base());
    return result;
  }

 private:
  std::vector<uint32_t> bodies_;  // in the order of entering
};

}  // namespace tilelight::reference
