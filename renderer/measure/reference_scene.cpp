// SPDX-License-Identifier: Apache-2.0
#include "renderer/measure/reference_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace tilelight {

using reference::Box;
using reference::BoxTree;
using reference::Coincident;
using reference::Hit;
using reference::kNoBody;
using reference::kRounding;
using reference::MeshTree;
using reference::Ray;
using reference::ReferenceBody;
using reference::ShearedRay;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Along a ray that grazes a surface, noise across the surface is this many times longer at most before we believe that
// it is distance.
constexpr double kGraze = 1e6;

double largest(const Vec3& v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

double steepness(const ReferenceBody& body, const Hit& hit, const Vec3& direction) {
  return std::fabs(glm::dot(geometric_normal(body, hit), direction));
}

}  // namespace

ReferenceScene::ReferenceScene(const Scene& scene)
    : materials_(scene.materials),
      lights_(scene.lights),
      background_(scene.background),
      ambient_(scene.ambient),
      attenuation_(scene.attenuation) {
  std::map<const TriMesh*, std::shared_ptr<const MeshTree>> trees;
  for (const Body& body : make_bodies(scene)) {
    std::shared_ptr<const MeshTree> mesh;
    if (body.kind == BodyKind::mesh) {
      auto& made = trees[body.mesh.get()];
      if (!made) made = std::make_shared<const MeshTree>(body.mesh);
      mesh = made;
    }
    const auto id = static_cast<uint32_t>(bodies_.size());
    bodies_.emplace_back(body, mesh);
    is_transmissive_.push_back(largest(materials_[body.material].transmission) > 0.0);
    Group& group = is_transmissive_.back() ? transmissive_ : opaque_;
    (body.kind == BodyKind::plane ? group.infinite : group.finite).push_back(id);
  }
  for (Group* group : {&opaque_, &transmissive_}) {
    std::vector<Box> boxes;
    for (const uint32_t id : group->finite) boxes.push_back(bodies_[id].bounds);
    group->tree = BoxTree(boxes);
  }
}

Ray ReferenceScene::ray_from(const Hit& left, const Vec3& direction, Coincident coincident) const {
  const ReferenceBody& body = bodies_[left.body];
  const Vec3 origin = body.world_point(left.local);
  return {origin, direction, left, coincident, kRounding * std::max(largest(origin), body.extent)};
}

// What the rounding of boxes' faces may put between two surfaces that the document has in one place.
double ReferenceScene::rounding_between(uint32_t a, uint32_t b) const {
  if (!is_transmissive_[a] && !is_transmissive_[b]) return 0.0;
  return bodies_[a].face_rounding + bodies_[b].face_rounding;
}

bool ReferenceScene::is_at_start(const Ray& ray, const Hit& hit) const {
  if (ray.left.body == kNoBody || std::fabs(hit.t) > ray.noise * kGraze) return false;
  const double noise = ray.noise + rounding_between(hit.body, ray.left.body);
  return std::fabs(hit.t) * steepness(bodies_[hit.body], hit, ray.direction) <= noise;
}

bool ReferenceScene::is_met_at_start(const Ray& ray, uint32_t id) const {
  if (id == ray.left.body) return false;
  const ReferenceBody &body = bodies_[id], &left = bodies_[ray.left.body];
  switch (ray.coincident) {
    case Coincident::none:
      return false;
    case Coincident::after:
      return body.rank > left.rank;
    case Coincident::before:
      return body.layer == Layer::film && body.rank < left.rank;
  }
  return false;
}

// Whether a hit lies ahead of the ray's start. Where the start itself lies on the hit surface within rounding, the
// order of layers decides instead of the sign of t.
bool ReferenceScene::is_ahead(const Ray& ray, const Hit& hit) const {
  return is_at_start(ray, hit) ? is_met_at_start(ray, hit.body) : hit.t > 0.0;
}

// The order in which surfaces are met: by distance, and by rank where the distances are the same within rounding; the
// other way round on the way back through films.
bool ReferenceScene::is_before(const Ray& ray, const Hit& hit, const Hit& best) const {
  const double rounding = rounding_between(hit.body, best.body);
  const double noise = kRounding * (largest(ray.origin) + std::fabs(best.t)) + rounding;
  const double gap = std::fabs(hit.t - best.t);
  if (gap > noise * kGraze) return hit.t < best.t;
  const double slope =
      std::max(steepness(bodies_[hit.body], hit, ray.direction), steepness(bodies_[best.body], best, ray.direction));
  if (gap * slope > noise) return hit.t < best.t;
  if (hit.body == best.body) return hit.primitive < best.primitive;
  const bool goes_back = ray.coincident == Coincident::before && is_at_start(ray, best);
  return (bodies_[hit.body].rank < bodies_[best.body].rank) != goes_back;
}

std::vector<Hit> ReferenceScene::surfaces_at(const Ray& ray, const Hit& hit) const {
  const ReferenceBody& owner = bodies_[hit.body];
  const Vec3 place = owner.world_point(hit.local);
  const double noise = kRounding * std::max(largest(place), owner.extent), reach = noise * kGraze;
  const Ray through{.origin = place, .direction = ray.direction};
  std::vector<Hit> found;
  const auto offer = [&](Hit other) {
    const double across = std::fabs(other.t) * steepness(bodies_[other.body], other, ray.direction);
    if (std::fabs(other.t) > reach || across > noise + rounding_between(other.body, hit.body)) return;
    if (other.body == hit.body && (other.primitive == hit.primitive || !owner.may_touch_itself)) return;
    other.t += hit.t;
    const bool is_left = other.body == ray.left.body && other.primitive == ray.left.primitive;
    if (!is_left && (!is_at_start(ray, other) || is_met_at_start(ray, other.body))) found.push_back(other);
  };
  const auto ask = [&](uint32_t id) {
    const ReferenceBody& body = bodies_[id];
    if (body.kind != BodyKind::mesh) {
      const reference::AnalyticHits hits = analytic_hits(body, id, through);
      for (int i = 0; i < hits.count; ++i) offer(hits.hits[i]);
      return false;
    }
    const ShearedRay local(body.local_point(place), body.local_from_world * ray.direction);
    body.mesh->tree.visit(local.origin, local.direction, -reach, reach, [&](uint32_t triangle) {
      if (const auto met = triangle_hit(*body.mesh->mesh, id, triangle, local)) offer(*met);
      return false;
    });
    return false;
  };
  found.push_back(hit);
  for (const Group* group : {&opaque_, &transmissive_}) {
    for (const uint32_t id : group->infinite) ask(id);
    group->tree.visit(place, ray.direction, -reach, reach, [&](uint32_t i) { return ask(group->finite[i]); });
  }
  std::sort(found.begin(), found.end(), [&](const Hit& a, const Hit& b) {
    return a.body != b.body ? bodies_[a.body].rank < bodies_[b.body].rank : a.primitive < b.primitive;
  });
  return found;
}

double ReferenceScene::way_through(const Hit& hit, const Vec3& direction) const {
  const Ray ray = ray_from(hit, direction, Coincident::none);
  double nearest = kInfinity;
  offer_body(hit.body, ray, nearest, [&](const Hit& other) {
    nearest = std::min(nearest, other.t);
    return false;
  });
  return nearest;
}

template <class Offer>
bool ReferenceScene::offer_body(uint32_t id, const Ray& ray, const double& t_max, Offer offer) const {
  const ReferenceBody& body = bodies_[id];
  if (body.kind != BodyKind::mesh) {
    const reference::AnalyticHits found = analytic_hits(body, id, ray);
    for (int i = 0; i < found.count; ++i)
      if (is_ahead(ray, found.hits[i])) return offer(found.hits[i]);
    return false;
  }
  const ShearedRay local(body.local_point(ray.origin), body.local_from_world * ray.direction);
  const TriMesh& mesh = *body.mesh->mesh;
  return body.mesh->tree.visit(local.origin, local.direction, -ray.noise * kGraze, t_max, [&](uint32_t triangle) {
    if (id == ray.left.body && triangle == ray.left.primitive) return false;
    const auto hit = triangle_hit(mesh, id, triangle, local);
    return hit && is_ahead(ray, *hit) && offer(*hit);
  });
}

template <class Offer>
bool ReferenceScene::offer_group(const Group& group, const Ray& ray, const double& t_max, Offer offer) const {
  for (const uint32_t id : group.infinite)
    if (offer_body(id, ray, t_max, offer)) return true;
  return group.tree.visit(ray.origin, ray.direction, -ray.noise * kGraze, t_max,
                          [&](uint32_t i) { return offer_body(group.finite[i], ray, t_max, offer); });
}

void ReferenceScene::find_nearest(const Group& group, const Ray& ray, std::optional<Hit>& best, double& t_max) const {
  offer_group(group, ray, t_max, [&](const Hit& hit) {
    if (!best || is_before(ray, hit, *best)) {
      best = hit;
      t_max = hit.t + kRounding * (largest(ray.origin) + std::fabs(hit.t)) * kGraze;  // ties are still to be found
    }
    return false;
  });
}

std::optional<Hit> ReferenceScene::nearest(const Ray& ray) const {
  std::optional<Hit> best;
  double t_max = kInfinity;
  find_nearest(opaque_, ray, best, t_max);
  find_nearest(transmissive_, ray, best, t_max);
  return best;
}

// Of surfaces in one place. Facets of a body that meet where the ray does are crossed once each way.
Color ReferenceScene::tint_of(const std::vector<Hit>& surfaces, const Vec3& direction) const {
  Color product(1.0);
  std::vector<std::pair<uint32_t, bool>> crossed;
  for (const Hit& hit : surfaces) {
    const std::pair way(hit.body, glm::dot(geometric_normal(bodies_[hit.body], hit), direction) < 0.0);
    if (std::find(crossed.begin(), crossed.end(), way) != crossed.end()) continue;
    crossed.push_back(way);
    product *= material(hit.body).transmission;
  }
  return product;
}

Color ReferenceScene::transmittance(const Ray& from, double distance) const {
  const bool is_blocked =
      offer_group(opaque_, from, distance, [&](const Hit& hit) { return hit.t < distance - from.noise; });
  if (is_blocked) return Color(0.0);
  Color passed(1.0);
  Ray ray = from;
  while (largest(passed) > 0.0) {
    std::optional<Hit> hit;
    double t_max = distance;
    find_nearest(transmissive_, ray, hit, t_max);
    if (!hit || hit->t >= distance - ray.noise) break;
    Coincident onward = Coincident::none;
    if (is_medium(hit->body)) {
      passed *= tint_of(surfaces_at(ray, *hit), ray.direction);
    } else {
      passed *= material(hit->body).transmission;
      const bool goes_back = ray.coincident == Coincident::before && is_at_start(ray, *hit);
      onward = goes_back ? Coincident::before : Coincident::after;
    }
    distance -= hit->t;
    ray = ray_from(*hit, ray.direction, onward);
  }
  return passed;
}

std::vector<uint32_t> ReferenceScene::media_around(const Vec3& point) const {
  const Vec3 direction = glm::normalize(Vec3(0.31415, 0.59265, 0.35897));  // in no plane that a modeller would choose
  std::vector<std::pair<double, uint32_t>> found;
  for (uint32_t id = 0; id < bodies_.size(); ++id) {
    if (!is_medium(id)) continue;
    for (const double exit : exit_distances(bodies_[id], point, direction)) found.emplace_back(-exit, id);
  }
  std::sort(found.begin(), found.end(), [&](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : bodies_[a.second].rank < bodies_[b.second].rank;
  });
  std::vector<uint32_t> ids;
  for (const auto& [order, id] : found) ids.push_back(id);
  return ids;
}

}  // namespace tilelight
