// SPDX-License-Identifier: Apache-2.0
// MediaStack: the media a ray is in. Where media overlap the one of the highest priority is there and the others are
// not (Schmidt and Budge 2002, Journal of Graphics Tools 7(4)); of equal priorities the one entered last.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "renderer/measure/reference_scene.h"

namespace tilelight::reference {

class MediaStack {
 public:
  MediaStack() = default;
  explicit MediaStack(std::vector<uint32_t> outermost_first) : bodies_(std::move(outermost_first)) {}

  // The index of refraction of what is there; 1 outside all media.
  double ior(const ReferenceScene& scene) const {
    const uint32_t id = top(scene);
    return id == kNoBody ? 1.0 : scene.material(id).ior;
  }

  // The medium that is there; kNoBody outside all media.
  uint32_t top(const ReferenceScene& scene) const {
    uint32_t best = kNoBody;
    for (const uint32_t id : bodies_)
      if (best == kNoBody || scene.material(id).priority >= scene.material(best).priority) best = id;
    return best;
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

// A place where a ray meets the surfaces of media, crossed as a whole: what is on this side, what is beyond, and which
// surface is the interface between the two. None: the same medium is on both sides.
struct Interface {
  MediaStack here, beyond;
  std::optional<Hit> shown;
};
// surfaces: of media, all in one place, by rank.
Interface make_interface(const ReferenceScene& scene, const MediaStack& media, const std::vector<Hit>& surfaces,
                         const Vec3& direction);

}  // namespace tilelight::reference
