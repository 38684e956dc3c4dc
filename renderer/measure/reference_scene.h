// SPDX-License-Identifier: Apache-2.0
// ReferenceScene: the scene as the reference renderer sees it, and the questions it asks of it: what does a ray meet
// first, how much light passes, in which media does a point lie. Immutable after construction; any thread.
#pragma once

#include <optional>
#include <vector>

#include "renderer/measure/reference_bodies.h"
#include "renderer/scene/scene.h"

namespace tilelight {

class ReferenceScene {
 public:
  explicit ReferenceScene(const Scene& scene);

  const reference::ReferenceBody& body(uint32_t id) const { return bodies_[id]; }
  const Material& material(uint32_t body_id) const { return materials_[bodies_[body_id].material]; }
  const std::vector<Light>& lights() const { return lights_; }
  const Background& background() const { return background_; }
  const Color& ambient() const { return ambient_; }
  const Attenuation& attenuation() const { return attenuation_; }

  // A medium: a solid whose material lets light through. Thin bodies (planes, open meshes, flat boxes) are none.
  bool is_medium(uint32_t body_id) const { return bodies_[body_id].has_inside && is_transmissive_[body_id]; }

  // A ray that starts on the surface `left`.
  reference::Ray ray_from(const reference::Hit& left, const Vec3& direction, reference::Coincident coincident) const;

  // The first surface on the ray. Surfaces closer together than rounding can tell are one place: the lowest rank, then
  // the lowest triangle, is the one that is seen.
  std::optional<reference::Hit> nearest(const reference::Ray& ray) const;

  // All surfaces in the place of a hit, it among them, by rank; without those that the ray has dealt with where it
  // started.
  std::vector<reference::Hit> surfaces_at(const reference::Ray& ray, const reference::Hit& hit) const;

  // How far it is from a hit through the body to its next surface.
  double way_through(const reference::Hit& hit, const Vec3& direction) const;

  // Whether a hit lies where the ray starts, within rounding.
  bool is_at_start(const reference::Ray& ray, const reference::Hit& hit) const;

  // The part of the light that comes through along the ray from `distance` away: 0 behind an opaque surface, else the
  // product of kt over the surfaces crossed, unrefracted.
  Color transmittance(const reference::Ray& ray, double distance) const;

  // The media in which a point lies, outermost first (by where a ray of fixed direction leaves them); as often as they
  // are around it.
  std::vector<uint32_t> media_around(const Vec3& point) const;

 private:
  // Bodies of one kind (opaque or transmissive), finite ones in a tree.
  struct Group {
    std::vector<uint32_t> finite, infinite;
    reference::BoxTree tree;  // over `finite`
  };
  template <class Offer>
  bool offer_body(uint32_t id, const reference::Ray& ray, const double& t_max, Offer offer) const;
  template <class Offer>
  bool offer_group(const Group& group, const reference::Ray& ray, const double& t_max, Offer offer) const;
  bool is_ahead(const reference::Ray& ray, const reference::Hit& hit) const;
  bool is_met_at_start(const reference::Ray& ray, uint32_t id) const;
  Color tint_of(const std::vector<reference::Hit>& surfaces, const Vec3& direction) const;
  double rounding_between(uint32_t a, uint32_t b) const;
  bool is_before(const reference::Ray& ray, const reference::Hit& hit, const reference::Hit& best) const;
  void find_nearest(const Group& group, const reference::Ray& ray, std::optional<reference::Hit>& best,
                    double& t_max) const;

  std::vector<reference::ReferenceBody> bodies_;
  std::vector<bool> is_transmissive_;
  std::vector<Material> materials_;
  std::vector<Light> lights_;
  Background background_;
  Color ambient_;
  Attenuation attenuation_;
  Group opaque_, transmissive_;
};

}  // namespace tilelight
