// SPDX-License-Identifier: Apache-2.0
// PlaceCrosser: takes rays across the surfaces of media, all those in one place together: what lies on the near side
// and what on the far side decides, not whose surface rounding or the order of the objects puts first. One thread.
#pragma once

#include <vector>

#include "renderer/shade/media.h"

namespace tilelight {

class PlaceCrosser {
 public:
  PlaceCrosser(const CompiledScene& scene, MediaSets& sets) : scene_(scene), sets_(sets) {}

  // A ray in these media meets a medium's surface. `hit` becomes the surface that shows there. It is no medium's if a
  // film or something opaque lies in the same place; then there is no crossing.
  Crossing cross(const Ray& ray, MediaSets::Set media, Hit& hit);

  // The part of the light that comes through the place, by channel: the product of kt of all that lies in it.
  Color tint(const Ray& ray, const Hit& hit);

 private:
  // What a ray does with a body whose surfaces lie in the place.
  struct Side {
    Hit first;      // no hit if the ray does not cross this way
    int inner = 0;  // surfaces that are met in their middle; on an edge one is met as two
    int count() const { return inner > 0 ? inner : first.is_hit(); }
  };
  struct Passage {
    uint32_t body = kNone;
    Side in, out;
  };
  void find_surfaces_at(const Ray& ray, const Hit& hit, const Vec3& place);
  void find_passages(const Vec3& place, const Vec3& direction);
  Crossing cross_all(const Vec3& place, const Vec3& direction, MediaSets::Set media, Hit& hit);
  void sort_outermost_first(const Vec3& place, const Vec3& direction);

  const CompiledScene& scene_;
  MediaSets& sets_;
  std::vector<Hit> surfaces_;      // of the place, by rank; t along the ray
  std::vector<Passage> passages_;  // by rank
  std::vector<uint32_t> entered_, left_, thinner_;
};

// Whether a point of a transparent mesh's surface is one where another of its shells begins: the ray leaves the one and
// enters the other.
bool is_between_shells(const CompiledScene& scene, const Ray& ray, const Hit& hit);

}  // namespace tilelight
