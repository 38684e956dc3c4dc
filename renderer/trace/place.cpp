// SPDX-License-Identifier: Apache-2.0
#include "renderer/trace/place.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "renderer/shade/surface.h"
#include "renderer/trace/intersect.h"
#include "renderer/trace/trace_rays.h"

namespace tilelight {
namespace {

bool goes_in(const CompiledScene& scene, const Vec3& place, const Vec3& direction, const Hit& hit) {
  const CompiledBody& body = scene.bodies[hit.body];
  const LocalRay local = to_local(body, {place, direction, {}, Coincident::none});
  return facing(body, local, direction, hit.prim, 0.0) < 0.0;
}

}  // namespace

void Passage::add(const CompiledScene& scene, const Vec3& place, const Vec3& direction, const Hit& hit) {
  constexpr double kOnEdge = 1e-9;
  Side& side = goes_in(scene, place, direction, hit) ? in : out;
  if (!side.first.is_hit()) side.first = hit;
  const bool is_inner = std::min({hit.b0, hit.b1, 1.0 - hit.b0 - hit.b1}) > kOnEdge;
  side.inner += is_inner && scene.bodies[hit.body].kind == BodyKind::mesh;
}

// Fills surfaces_. What the ray has dealt with where it starts is not among them.
void PlaceCrosser::find_surfaces_at(const Ray& ray, const Hit& hit, const Vec3& place) {
  find_surfaces(scene_, place, ray.direction, hit.body, surfaces_);
  for (Hit& other : surfaces_) other.t += hit.t;
  std::erase_if(surfaces_, [&](const Hit& other) {
    if (other.body == hit.body && (other.prim == hit.prim || !scene_.bodies[hit.body].may_touch_itself)) return true;
    if (other.body == ray.left.body && other.prim == ray.left.prim) return true;
    return lies_at_start(scene_, ray, other) && !is_met_at_start(scene_, ray, other.body);
  });
  surfaces_.push_back(hit);
  std::sort(surfaces_.begin(), surfaces_.end(), [&](const Hit& a, const Hit& b) {
    const uint32_t rank_a = scene_.bodies[a.body].rank, rank_b = scene_.bodies[b.body].rank;
    return rank_a != rank_b ? rank_a < rank_b : a.prim < b.prim;
  });
}

// Fills passages_, one a body.
void PlaceCrosser::find_passages(const Vec3& place, const Vec3& direction) {
  passages_.clear();
  for (const Hit& hit : surfaces_) {
    if (passages_.empty() || passages_.back().body != hit.body) passages_.push_back({hit.body, {}, {}});
    passages_.back().add(scene_, place, direction, hit);
  }
}

// Of media that are entered together the one that the way leaves last is the outermost, as if the others lay in it.
void PlaceCrosser::sort_outermost_first(const Vec3& place, const Vec3& direction) {
  if (entered_.size() < 2) return;
  std::vector<std::pair<double, uint32_t>> by_exit;  // entered_ is by rank
  for (const uint32_t body : entered_) {
    const auto passage =
        std::find_if(passages_.begin(), passages_.end(), [&](const Passage& p) { return p.body == body; });
    const Ray inside{place, direction, {body, passage->in.first.prim}, Coincident::none};
    by_exit.emplace_back(trace_body(scene_, body, inside).t, body);
  }
  using Exit = std::pair<double, uint32_t>;
  std::stable_sort(by_exit.begin(), by_exit.end(), [](const Exit& a, const Exit& b) { return a.first > b.first; });
  // Exits closer together than a long way is rounded by are in one place, in which rank counts.
  for (auto first = by_exit.begin(); first != by_exit.end();) {
    const double same = first->first * (1.0 - 0x1p-40);
    const auto last = std::find_if(first, by_exit.end(), [&](const Exit& exit) { return exit.first < same; });
    std::sort(first, last, [&](const Exit& a, const Exit& b) { return sets_.rank(a.second) < sets_.rank(b.second); });
    first = last;
  }
  for (size_t i = 0; i < entered_.size(); ++i) entered_[i] = by_exit[i].second;
}

Crossing PlaceCrosser::cross_all(const Vec3& place, const Vec3& direction, MediaSets::Set media, Hit& hit) {
  find_passages(place, direction);
  entered_.clear(), left_.clear(), thinner_.clear();
  for (const Passage& passage : passages_) {
    const int net = passage.net();
    if (net > 0) entered_.insert(entered_.end(), static_cast<size_t>(net), passage.body);
    if (net < 0) left_.insert(left_.end(), static_cast<size_t>(-net), passage.body);
    // A body of which the ray leaves one shell and enters the next goes on.
    if (net == 0 && !sets_.contains(media, passage.body)) thinner_.push_back(passage.body);
  }
  sort_outermost_first(place, direction);
  const Crossing crossing(sets_, media, entered_, left_, thinner_);
  for (const Passage& passage : passages_) {
    if (passage.body != crossing.seen) continue;
    hit = passage.net() >= 0 ? passage.in.first : passage.out.first;
  }
  return crossing;
}

Crossing PlaceCrosser::cross(const Ray& ray, MediaSets::Set media, Hit& hit) {
  const Surface surface = make_surface(scene_, ray, hit);
  if (!scene_.bodies[hit.body].may_touch_media) return {sets_, media, hit.body, surface.from_outside};
  find_surfaces_at(ray, hit, surface.position);
  if (!is_medium(scene_, surfaces_[0].body)) {
    hit = surfaces_[0];
    return {};
  }
  if (surfaces_.size() == 1) return {sets_, media, hit.body, surface.from_outside};
  return cross_all(surface.position, ray.direction, media, hit);
}

Color PlaceCrosser::tint(const Ray& ray, const Hit& hit) {
  const auto kt = [&](uint32_t body) { return scene_.materials[scene_.bodies[body].material].source.transmission; };
  if (!scene_.bodies[hit.body].may_touch_media) return kt(hit.body);
  const Vec3 place = ray.origin + hit.t * ray.direction;
  find_surfaces_at(ray, hit, place);
  find_passages(place, ray.direction);
  Color product(1.0);
  for (const Passage& passage : passages_) {
    if (passage.in.first.is_hit()) product *= kt(passage.body);
    if (passage.out.first.is_hit()) product *= kt(passage.body);
  }
  return product;
}

int times_entered(const CompiledScene& scene, const Ray& ray, const Hit& hit) {
  const Surface surface = make_surface(scene, ray, hit);
  if (!scene.bodies[hit.body].may_touch_itself) return surface.from_outside ? 1 : -1;
  std::vector<Hit> surfaces;
  find_surfaces(scene, surface.position, ray.direction, hit.body, surfaces);
  Passage passage{hit.body, {}, {}};
  passage.add(scene, surface.position, ray.direction, hit);
  for (const Hit& other : surfaces) {
    if (other.body == hit.body && other.prim != hit.prim) passage.add(scene, surface.position, ray.direction, other);
  }
  return passage.net();
}

}  // namespace tilelight
