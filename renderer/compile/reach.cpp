// SPDX-License-Identifier: Apache-2.0
#include "renderer/compile/reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "renderer/compile/compile.h"
#include "renderer/compile/passes.h"

namespace tilelight {
namespace {

// Looking at more would take longer than a plan may: a body takes about a tenth of a microsecond.
constexpr size_t kMostBodies = 4096;
// Samples lie up to one pixel outside the picture; the second is for rounding.
constexpr double kReachPx = 2.0;
// Above what rounding may do to coordinates near 1, and to their products with a unit vector.
constexpr double kSlack = 0x1p-30, kRelativeSlack = 0x1p-40;

double slack_at(const Vec3& p) { return kSlack + kRelativeSlack * (std::abs(p.x) + std::abs(p.y) + std::abs(p.z)); }

// n . (x - p) >= 0, n unit.
struct HalfSpace {
  Vec3 normal, point;

  // The most that a box, seen from `from`, reaches along the normal.
  double reach_of(const Box& box, const Vec3& from) const {
    const Vec3 farthest(normal.x > 0.0 ? box.hi.x : box.lo.x, normal.y > 0.0 ? box.hi.y : box.lo.y,
                        normal.z > 0.0 ? box.hi.z : box.lo.z);
    return glm::dot(normal, farthest - from);
  }
  // margin: how far outside counts as inside.
  bool excludes(const Box& box, double margin) const { return reach_of(box, point) < -margin - slack_at(point); }
};

// What primary rays may cross: ahead of the eye, between the four sides of the picture.
using Frustum = std::array<HalfSpace, 5>;

// None if the eye's numbers are too extreme to tell.
std::optional<Frustum> frustum_of(const Eye& eye, int width, int height) {
  Frustum out;
  out[0] = {eye.forward, eye.start};
  for (int side = 0; side < 4; ++side) {
    const bool is_across = side < 2, is_far = side % 2 == 1;
    const double x = is_across ? (is_far ? width + kReachPx : -kReachPx) : 0.5 * width;
    const double y = is_across ? 0.5 * height : (is_far ? height + kReachPx : -kReachPx);
    const Vec3 off = eye.corner + x * eye.step_x + y * eye.step_y;
    const Vec3 ray = eye.projection == Projection::orthographic ? eye.forward : glm::normalize(eye.forward + off);
    const Vec3 along = is_across ? eye.step_y : eye.step_x;
    Vec3 normal = glm::normalize(glm::cross(ray, glm::normalize(along)));
    const Vec3 inward = (is_far ? -1.0 : 1.0) * (is_across ? eye.step_x : eye.step_y);
    if (glm::dot(normal, inward) < 0.0) normal = -normal;
    out[static_cast<size_t>(side) + 1] = {normal, eye.start + eye.lead * off};
  }
  for (const HalfSpace& half : out) {
    const double sum = glm::dot(half.normal, half.normal) + glm::dot(half.point, half.point);
    if (!std::isfinite(sum)) return {};
  }
  return out;
}

bool meets(const Frustum& frustum, const Box& box) {
  return std::none_of(frustum.begin(), frustum.end(), [&](const HalfSpace& half) { return half.excludes(box, 0.0); });
}

// Whether the shadow of a box, all that lies behind it as seen from the light, may meet the frustum. margin: how far
// shadow rays may start outside of it.
bool may_shade(const Frustum& frustum, const Box& box, const CompiledLight& light, double margin) {
  return std::none_of(frustum.begin(), frustum.end(), [&](const HalfSpace& half) {
    if (!half.excludes(box, margin)) return false;
    return light.kind == LightKind::point ? half.reach_of(box, light.position) < -slack_at(light.position)
                                          : glm::dot(half.normal, -light.to_light) < -kRelativeSlack;
  });
}

// A box around all shadow rays from a box to a light.
Box swept(Box box, const CompiledLight& light) {
  if (light.kind == LightKind::point) {
    box.grow(light.position);
    return box;
  }
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (light.to_light[axis] > kRelativeSlack) box.hi[axis] = kEndless;
    if (light.to_light[axis] < -kRelativeSlack) box.lo[axis] = -kEndless;
  }
  return box;
}

bool overlap(const Box& a, const Box& b, double margin) {
  for (int axis = 0; axis < 3; ++axis) {
    if (a.lo[axis] > b.hi[axis] + margin || b.lo[axis] > a.hi[axis] + margin) return false;
  }
  return true;
}

// As the picture has the body: with what rounding does to its faces.
Box box_of(const CompiledBody& body) {
  Box box = body_bounds(body);
  Vec3 rounding(kSlack);
  for (int column = 0; column < 3; ++column)
    rounding += glm::abs(Vec3(body.world_from_local[column])) * body.rounding[column];
  box.lo -= rounding, box.hi += rounding;
  return box;
}

// How far above a facet of the body a shadow ray may start: see place_on_curve in shade/surface-inl.h.
double most_lift(const CompiledBody& body) {
  if (body.kind != BodyKind::mesh || body.mesh->corner_normals.empty()) return 0.0;
  constexpr double kLongest = 4.0;  // above the diagonal of [-1, 1]
  double squares = 0.0;
  for (int column = 0; column < 3; ++column)
    squares += glm::dot(Vec3(body.world_from_local[column]), Vec3(body.world_from_local[column]));
  return kLongest * std::sqrt(squares);
}

bool leads_on(const CompiledScene& scene, const CompiledBody& body) {
  const CompiledMaterial& m = scene.materials[body.material];
  return m.is_reflective || m.is_transmissive;
}

class Finder {
 public:
  Finder(const CompiledScene& scene, const RenderSpec& spec, const Frustum& frustum)
      : scene_(scene), spec_(spec), frustum_(frustum) {}

  Reach find() {
    const size_t count = scene_.bodies.size();
    Reach out{std::vector<bool>(count, false), std::vector<bool>(count, false)};
    for (size_t i = 0; i < count; ++i) {
      const CompiledBody& body = scene_.bodies[i];
      const bool is_plane = i >= scene_.finite_bodies;
      boxes_.push_back(is_plane ? Box{} : box_of(body));
      if (!is_plane && !meets(frustum_, boxes_[i])) continue;
      if (spec_.max_depth > 0 && leads_on(scene_, body)) return Reach::everything(count);
      out.is_seen[i] = out.casts[i] = true;
      see(body, boxes_[i], is_plane);
    }
    if (!spec_.shadows) return out;
    for (const CompiledLight& light : scene_.lights) {
      if (light.shadow) add_casters(light, out);
    }
    return out;
  }

 private:
  void see(const CompiledBody& body, const Box& box, bool is_plane) {
    if (spec_.terminator == Terminator::smooth) lift_ = std::max(lift_, most_lift(body));
    sees_plane_ |= is_plane;
    seen_.grow(box);
  }

  void add_casters(const CompiledLight& light, Reach& out) const {
    if (!sees_plane_ && seen_.is_empty()) return;
    const Box lit = swept(seen_, light);
    const double margin = lift_ + (light.kind == LightKind::point ? slack_at(light.position) : kSlack);
    for (size_t i = 0; i < scene_.finite_bodies; ++i) {
      if (out.casts[i]) continue;
      out.casts[i] = (sees_plane_ || overlap(lit, boxes_[i], margin)) && may_shade(frustum_, boxes_[i], light, lift_);
    }
  }

  const CompiledScene& scene_;
  const RenderSpec& spec_;
  const Frustum& frustum_;
  std::vector<Box> boxes_;  // by body
  Box seen_;                // of all finite bodies that are seen
  bool sees_plane_ = false;
  double lift_ = 0.0;
};

}  // namespace

size_t Reach::count() const { return static_cast<size_t>(std::count(casts.begin(), casts.end(), true)); }

Reach find_reach(const CompiledScene& scene, const ViewPlan& plan) {
  const RenderSpec& spec = plan.view.render;
  const ImageSpec& image = plan.view.image;
  // Views drawn from triangles set up all of them, and put them in places of their own.
  if (is_tessellated(spec) || scene.bodies.size() > kMostBodies) return Reach::everything(scene.bodies.size());
  const std::optional<Frustum> frustum = frustum_of(plan.eye, image.width, image.height);
  return frustum ? Finder(scene, spec, *frustum).find() : Reach::everything(scene.bodies.size());
}

}  // namespace tilelight
