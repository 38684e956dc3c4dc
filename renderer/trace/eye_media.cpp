// SPDX-License-Identifier: Apache-2.0
#include "renderer/trace/eye_media.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderer/compile/passes.h"
#include "renderer/shade/surface.h"
#include "renderer/trace/intersect.h"
#include "renderer/trace/place.h"
#include "renderer/trace/trace_rays.h"

namespace tilelight {
namespace {

constexpr auto kAhead = [](double t, uint32_t) { return t > 0.0; };
constexpr auto kExact = [] { return Vec3(0.0); };

// The winding number by the ways out less the ways in. It falls by one where the mesh ends once more.
void find_mesh_exits(const CompiledScene& scene, uint32_t index, Ray ray, std::vector<double>& exits) {
  const bool nearest_tells = scene.bodies[index].mesh->is_known_outward;
  std::vector<std::pair<double, int>> entries;  // along the ray: how far, and how often more entered than left
  int around = 0;
  for (double gone = 0.0;;) {
    const Hit hit = trace_body(scene, index, ray);
    if (!hit.is_hit()) break;
    gone += hit.t;
    entries.emplace_back(gone, times_entered(scene, ray, hit));
    around -= entries.back().second;
    if (nearest_tells && entries.back().second != 0) break;
    const Surface surface = make_surface(scene, ray, hit);
    ray = {surface.position, ray.direction, surface.here, Coincident::none};
  }
  int least = around;
  for (const auto& [distance, entered] : entries) {
    around += entered;
    for (; least > std::max(around, 0); --least) exits.push_back(distance);
  }
}

// Adds how far it is along the ray to where the body ends: once for every time that it is around the ray's start.
void find_exits(const CompiledScene& scene, uint32_t index, const Ray& world_ray, std::vector<double>& exits) {
  const CompiledBody& body = scene.bodies[index];
  const LocalRay ray = to_local(body, world_ray);
  const Vec3 p = glm::abs(ray.origin);
  double t = 0.0;
  uint32_t face = 0;
  switch (body.kind) {
    case BodyKind::sphere:
      if (glm::dot(p, p) < 1.0 && intersect_sphere(ray, false, kAhead, t)) exits.push_back(t);
      break;
    case BodyKind::box:
      if (p.x < body.half.x && p.y < body.half.y && p.z < body.half.z &&
          intersect_box(body.half, ray, kNone, kAhead, kExact, t, face))
        exits.push_back(t);
      break;
    case BodyKind::mesh:
      find_mesh_exits(scene, index, world_ray, exits);
      break;
    case BodyKind::plane:
      break;
  }
}

struct Interval {
  double low, high;
};
// The values of (p - origin) . axis over a box.
Interval reach_along(const Box& box, const Vec3& origin, const Vec3& axis) {
  const double middle = glm::dot(0.5 * (box.lo + box.hi) - origin, axis);
  const double rounding = 0x1p-40 * (1.0 + glm::length(origin));  // more than there is
  const double half = glm::dot(0.5 * (box.hi - box.lo) + rounding, glm::abs(axis));
  return {middle - half, middle + half};
}

}  // namespace

EyeMedia::EyeMedia(const CompiledScene& scene, const ViewPlan& plan) : scene_(scene) {
  if (plan.eye.projection == Projection::orthographic) {
    find_cuts(plan.eye);
    return;
  }
  MediaList all;
  for (uint32_t i = 0; i < scene.finite_bodies; ++i) {
    if (is_medium(scene, i)) all.push_back(i);
  }
  around_all_ = around(plan.eye.origin, all);
}

void EyeMedia::find_cuts(const Eye& eye) {
  const Vec3 corner = eye.origin + eye.corner;
  for (uint32_t i = 0; i < scene_.finite_bodies; ++i) {
    if (!is_medium(scene_, i)) continue;
    const Box box = body_bounds(scene_.bodies[i]);
    const Interval depth = reach_along(box, corner, eye.forward);
    if (depth.low > 0.0 || depth.high < 0.0) continue;
    const Interval x = reach_along(box, corner, eye.step_x / glm::dot(eye.step_x, eye.step_x));
    const Interval y = reach_along(box, corner, eye.step_y / glm::dot(eye.step_y, eye.step_y));
    cuts_.push_back({i, x.low, y.low, x.high, y.high});
  }
}

MediaList EyeMedia::some_near(const TileRect& pixels) const {
  MediaList some;
  for (const Cut& cut : cuts_) {  // NaN, of pixels too small to divide by, may be anywhere
    if (cut.x0 > pixels.x1 || cut.x1 < pixels.x0 || cut.y0 > pixels.y1 || cut.y1 < pixels.y0) continue;
    some.push_back(cut.body);
  }
  return some;
}

MediaList EyeMedia::around(const Vec3& start, std::span<const uint32_t> some) const {
  // Along no axis or diagonal of a modelled shape.
  const Ray ray{start, glm::normalize(Vec3(0.31415, 0.59265, 0.35897)), {}};
  std::vector<std::pair<double, uint32_t>> found;  // by distance, the farthest first: the order of entering
  std::vector<double> exits;
  for (const uint32_t body : some) {
    exits.clear();
    find_exits(scene_, body, ray, exits);
    for (const double exit : exits) found.emplace_back(-exit, body);
  }
  std::sort(found.begin(), found.end(), [&](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : scene_.bodies[a.second].rank < scene_.bodies[b.second].rank;
  });
  MediaList media;
  for (const auto& [order, body] : found) media.push_back(body);
  return media;
}

}  // namespace tilelight
