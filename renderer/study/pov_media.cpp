// SPDX-License-Identifier: Apache-2.0
#include "renderer/study/pov_media.h"

#include <algorithm>
#include <cmath>

#include "renderer/study/pov_space.h"

namespace tilelight {
namespace {

constexpr double kTouch = 1e-6;  // of the larger body

struct Placed {
  const Body* body;
  const Material* material;
  Box box;
  bool is_clear() const { return material->transmission != Color(0.0); }
};

double size_of(const Box& box) { return glm::length(box.hi - box.lo); }

// How far two boxes go into each other along the axis in which they do so least; negative: they are apart.
double overlap(const Box& a, const Box& b) {
  const Vec3 depth = glm::min(a.hi, b.hi) - glm::max(a.lo, b.lo);
  return std::min({depth.x, depth.y, depth.z});
}

// The longest way from a body's middle to its surface, in another space; for an ellipsoid at most too long.
double reach_of_sphere(const Mat3& to_space) {
  const double x = glm::length(to_space[0]), y = glm::length(to_space[1]), z = glm::length(to_space[2]);
  const bool is_round = std::abs(x - y) <= kTouch * x && std::abs(x - z) <= kTouch * x;
  return is_round ? x : std::sqrt(x * x + y * y + z * z);
}

// Whether all of a body is well inside of another one that is round or square.
bool is_within(const Placed& inner, const Body& outer) {
  if (outer.kind != BodyKind::sphere && outer.kind != BodyKind::box) return false;
  const Mat4 local_from_world = glm::inverse(outer.world_from_local);
  if (inner.body->kind == BodyKind::sphere && outer.kind == BodyKind::sphere) {
    const Mat4 place = local_from_world * inner.body->world_from_local;
    return glm::length(Vec3(place[3])) + reach_of_sphere(Mat3(place)) < 1.0 - kTouch;
  }
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p = glm::abs(Vec3(local_from_world * Vec4(corner_of(inner.box, corner), 1.0)));
    const Vec3 part = p / outer.half;
    const double most = outer.kind == BodyKind::box ? std::max({part.x, part.y, part.z}) : glm::length(p);
    if (!(most < 1.0 - kTouch)) return false;
  }
  return true;
}

// A ray that leaves one medium for another meets no Fresnel term in POV-Ray.
bool is_nested_alike(const Placed& inner, const Placed& outer) {
  return is_within(inner, *outer.body) && inner.body->has_inside &&
         inner.material->priority >= outer.material->priority && !inner.material->fresnel;
}

bool do_meet(const Placed& a, const Placed& b) {
  const double depth = overlap(a.box, b.box), least = kTouch * std::max(size_of(a.box), size_of(b.box));
  if (depth < -least) return false;
  if (a.is_clear() && b.is_clear()) return !is_nested_alike(a, b) && !is_nested_alike(b, a);
  // Glass on what is opaque: alike unless they share a face.
  const bool is_round = a.body->kind == BodyKind::sphere || b.body->kind == BodyKind::sphere;
  return !is_round && std::abs(depth) <= least;
}

// A flat face that lies in the plane; of two that are clear, any part of one body on both sides of the other.
bool do_meet(const Placed& body, const Body& plane, bool is_plane_clear) {
  const Mat4 local_from_world = glm::inverse(plane.world_from_local);
  double lowest = INFINITY, highest = -INFINITY;
  for (int corner = 0; corner < 8; ++corner) {
    const double height = (local_from_world * Vec4(corner_of(body.box, corner), 1.0)).y;
    lowest = std::min(lowest, height), highest = std::max(highest, height);
  }
  const double least = kTouch * (highest - lowest);
  if (is_plane_clear && body.is_clear()) return lowest <= least && highest >= -least;
  const bool is_shared = std::abs(lowest) <= least || std::abs(highest) <= least;
  return (is_plane_clear || body.is_clear()) && body.body->kind != BodyKind::sphere && is_shared;
}

}  // namespace

bool do_media_meet(const Scene& scene, const std::vector<Body>& bodies) {
  std::vector<Placed> placed;
  for (const Body& body : bodies) {
    const Box box = world_bounds(body);
    if (!box.is_empty()) placed.push_back({&body, &scene.materials[body.material], box});
  }
  std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) { return a.box.lo.x < b.box.lo.x; });
  for (size_t i = 0; i < placed.size(); ++i) {
    const double reach = placed[i].box.hi.x + kTouch * size_of(placed[i].box);
    for (size_t j = i + 1; j < placed.size() && placed[j].box.lo.x <= reach; ++j) {
      if ((placed[i].is_clear() || placed[j].is_clear()) && do_meet(placed[i], placed[j])) return true;
    }
  }
  for (const Body& plane : bodies) {
    if (plane.kind != BodyKind::plane) continue;
    const bool is_clear = scene.materials[plane.material].transmission != Color(0.0);
    for (const Placed& body : placed)
      if (do_meet(body, plane, is_clear)) return true;
  }
  return false;
}

}  // namespace tilelight
