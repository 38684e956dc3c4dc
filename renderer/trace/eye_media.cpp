// SPDX-License-Identifier: Apache-2.0
#include "renderer/trace/eye_media.h"

#include <algorithm>
#include <cmath>
#include <optional>
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

// Inside or outside by the sign of Ng.d at the nearest triangle along the ray; where two shells touch, the one side is
// as good as the other, and the next triangle tells.
std::optional<double> mesh_exit(const CompiledScene& scene, uint32_t index, const Ray& ray) {
  Ray on = ray;
  for (double gone = 0.0;;) {
    const Hit hit = trace_body(scene, index, on);
    if (!hit.is_hit()) return std::nullopt;
    const Surface surface = make_surface(scene, on, hit);
    gone += hit.t;
    if (!is_between_shells(scene, on, hit)) return surface.from_outside ? std::nullopt : std::optional(gone);
    on = {surface.position, ray.direction, surface.here, Coincident::none};
  }
}

// How far it is along the ray to the surface of the body; none if the ray starts outside.
std::optional<double> exit_distance(const CompiledScene& scene, uint32_t index, const Ray& world_ray) {
  const CompiledBody& body = scene.bodies[index];
  const LocalRay ray = to_local(body, world_ray);
  const Vec3 p = glm::abs(ray.origin);
  double t = 0.0;
  uint32_t face = 0;
  switch (body.kind) {
    case BodyKind::sphere:
      if (!(glm::dot(p, p) < 1.0) || !intersect_sphere(ray, false, kAhead, t)) return std::nullopt;
      return t;
    case BodyKind::box:
      if (!(p.x < body.half.x && p.y < body.half.y && p.z < body.half.z)) return std::nullopt;
      return intersect_box(body.half, ray, kNone, kAhead, kExact, t, face) ? std::optional(t) : std::nullopt;
    case BodyKind::mesh:
      return mesh_exit(scene, index, world_ray);
    case BodyKind::plane:
      break;
  }
  return std::nullopt;
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
  for (const uint32_t body : some) {
    if (const auto exit = exit_distance(scene_, body, ray)) found.emplace_back(-*exit, body);
  }
  std::sort(found.begin(), found.end(), [&](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : scene_.bodies[a.second].rank < scene_.bodies[b.second].rank;
  });
  MediaList media;
  for (const auto& [order, body] : found) media.push_back(body);
  return media;
}

}  // namespace tilelight
