// SPDX-License-Identifier: Apache-2.0
// PlaceCrosser: takes rays across the surfaces of media, all those in one place together: what lies on the near side
// and what on the far side decides, not whose surface rounding or the order of the objects puts first. One thread.
#pragma once

#include <vector>

#include "renderer/shade/media.h"

namespace tilelight {

// What a ray does with a body whose surfaces lie in one place.
struct Passage {
  struct Side {
    Hit first;      // no hit if the ray does not cross this way
    int inner = 0;  // surfaces that are met in their middle; on an edge one is met as two
    int count() const { return inner > 0 ? inner : first.is_hit(); }
  };
  uint32_t body = kNone;
  Side in, out;

  void add(const CompiledScene& scene, const Vec3& place, const Vec3& direction, const Hit& hit);
  int net() const { return in.count() - out.count(); }  // how often more it is entered than left
};

class PlaceCrosser {
 public:
  PlaceCrosser(const CompiledScene& scene, MediaSets& sets) : scene_(scene), sets_(sets) {}

  // A ray in these media meets a medium's surface. `hit` becomes the surface that shows there. It is no medium's if a
  // film or something opaque lies in the same place; then there is no crossing.
  Crossing cross(const Ray& ray, MediaSets::Set media, Hit& hit);

  // The part of the light that comes through the place, by channel: the product of kt of all that lies in it.
  Color tint(const Ray& ray, const Hit& hit);

 private:
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

// How often more the ray enters the body than it leaves it where it meets it, all of its surfaces in the place taken
// together: 0 where it goes from one shell of a mesh into the next.
int times_entered(const CompiledScene& scene, const Ray& ray, const Hit& hit);

}  // namespace tilelight
