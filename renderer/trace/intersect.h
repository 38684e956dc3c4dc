// SPDX-License-Identifier: Apache-2.0
// Exact intersections, in double: what the float filters let through is decided here, and nowhere else. All
// work in a body's local space; t is that of the world ray, whose direction is unit. Pure; any thread.
#pragma once

#include <cmath>
#include <limits>

#include "renderer/base/safe_length.h"
#include "renderer/compile/compiled_scene.h"
#include "renderer/shade/ray.h"

namespace tilelight {

// A ray in a body's local space; the direction keeps its length, so t means the same as in the world.
struct LocalRay {
  Vec3 origin{0.0}, direction{0.0};
};
inline LocalRay to_local(const CompiledBody& body, const Ray& ray) {
  return {transform_point(body.local_from_world, ray.origin), transform_vector(body.local_from_world, ray.direction)};
}

// Inside two units of the centre the origin may stay.
inline constexpr double kNearOrigin2 = 4.0;
// The origin moved along the ray by `shift` (of t) to near the centre.
inline Vec3 moved_origin(const LocalRay& ray, double& shift) {
  const double d2 = glm::dot(ray.direction, ray.direction);
  shift = glm::dot(ray.origin, ray.origin) > kNearOrigin2 ? -glm::dot(ray.origin, ray.direction) / d2 : 0.0;
  Vec3 moved = ray.origin + shift * ray.direction;
  if (glm::dot(moved, moved) > kNearOrigin2) {  // so far away that the shift itself was rounded by units: once more
    const double rest = -glm::dot(moved, ray.direction) / d2;
    shift += rest;
    moved += rest * ray.direction;
  }
  return moved;
}

// Where a ray starts on a surface, other surfaces may lie in the same place, within the rounding of a point near the
// scene. Along the ray that rounding is longer the flatter the ray meets the surface, up to `reach`.
struct Start {
  double noise = 0.0;  // across a surface, normalised units; 0 for a ray from the eye
  double reach = 0.0;  // along the ray
};
// size: |x| + |y| + |z| of the start.
inline double noise_at(double size) { return 0x1p-44 * (1.0 + size); }
inline double reach_at(double size) { return 0x1p20 * noise_at(size); }
inline Start start_of(const Ray& ray) {
  if (ray.left.body == kNone) return {};
  const double size = std::abs(ray.origin.x) + std::abs(ray.origin.y) + std::abs(ray.origin.z);
  return {noise_at(size), reach_at(size)};
}

// Cosine between a world direction and the body's geometric normal, outward, at a hit at t.
inline double facing(const CompiledBody& body, const LocalRay& ray, const Vec3& world_direction, uint32_t prim,
                     double t) {
  Vec3 n(0.0);
  switch (body.kind) {
    case BodyKind::sphere:
      n = ray.origin + t * ray.direction;
      break;
    case BodyKind::box:
      n[static_cast<int>(prim / 2)] = prim % 2 ? 1.0 : -1.0;
      break;
    case BodyKind::plane:
      n.y = 1.0;
      break;
    case BodyKind::mesh: {
      const auto& tri = body.mesh->triangles[prim];
      const Vec3& a = body.mesh->positions[tri[0]];
      n = cross_of(body.mesh->positions[tri[1]] - a, body.mesh->positions[tri[2]] - a);
    }
  }
  return glm::dot(unit_of(body.world_from_normal * n), world_direction);
}
inline double steepness(const CompiledBody& body, const LocalRay& ray, const Vec3& world_direction, uint32_t prim,
                        double t) {
  return std::abs(facing(body, ray, world_direction, prim, t));
}

// How far two bodies' surfaces may lie apart, by the rounding of numbers far from the origin, that the document puts in
// one place. It matters where light goes on from the one into the other.
inline double face_rounding(const CompiledBody& a, const CompiledBody& b) {
  return a.layer == Layer::opaque && b.layer == Layer::opaque ? 0.0 : a.face_rounding + b.face_rounding;
}

// Whether a hit lies in the place where its ray starts.
inline bool lies_at_start(const CompiledScene& scene, const Ray& ray, const Hit& hit) {
  const Start start = start_of(ray);
  if (ray.left.body == kNone || !(std::abs(hit.t) <= start.reach)) return false;
  const CompiledBody& body = scene.bodies[hit.body];
  const double across = std::abs(hit.t) * steepness(body, to_local(body, ray), ray.direction, hit.prim, hit.t);
  return across <= start.noise + face_rounding(body, scene.bodies[ray.left.body]);
}

// Whether a ray meets a body's surface that lies in the place where it starts.
inline bool is_met_at_start(const CompiledScene& scene, const Ray& ray, uint32_t index) {
  if (index == ray.left.body || ray.coincident == Coincident::none) return false;
  const CompiledBody &body = scene.bodies[index], &left = scene.bodies[ray.left.body];
  if (ray.coincident == Coincident::after) return body.rank > left.rank;
  return body.rank < left.rank && body.layer == Layer::film;
}

// Unit sphere. Hearn and Baker's form (Haines et al., Ray Tracing Gems ch. 7): the discriminant as a squared distance
// from the centre, and no difference of nearly equal numbers in the roots. has_left: the origin lies on the sphere.
// is_ahead(t, prim): whether a hit counts, asked from the nearest on.
template <class IsAhead>
bool intersect_sphere(const LocalRay& ray, bool has_left, const IsAhead& is_ahead, double& t) {
  const Vec3 &o = ray.origin, &d = ray.direction;
  const double a = glm::dot(d, d);
  const double b = -glm::dot(o, d);
  const Vec3 nearest = o + (b / a) * d;
  const double discriminant = 1.0 - glm::dot(nearest, nearest);
  if (!(discriminant >= 0.0)) return false;
  const double q = b + std::copysign(std::sqrt(a * discriminant), b);
  if (has_left) {  // one root is the origin itself; the other lies ahead only for a ray that goes inward
    if (!(b > 0.0)) return false;
    t = q / a;
    return true;
  }
  const double c = glm::dot(o, o) - 1.0;
  const double r0 = c / q, r1 = q / a;
  const double near = std::fmin(r0, r1), far = std::fmax(r0, r1);
  if (is_ahead(near, 0)) {
    t = near;
    return true;
  }
  t = far;
  return is_ahead(far, 0);
}

// How far the ray and a box's faces may lie, in the box's local space, from where the numbers of the scene put them:
// what the document's own numbers were rounded by, and a few roundings of the rebase, the matrices and the direction,
// with a margin. By axis of that space.
inline Vec3 local_rounding(const CompiledBody& body, const Ray& ray) {
  const Mat4& m = body.local_from_world;
  const Vec3 size = 1.0 + glm::abs(ray.origin);
  return body.rounding +
         0x1p-50 * (glm::abs(Vec3(m[0])) * size.x + glm::abs(Vec3(m[1])) * size.y + glm::abs(Vec3(m[2])) * size.z);
}

struct BoxSpan {
  double near = -std::numeric_limits<double>::infinity(), far = std::numeric_limits<double>::infinity();
  uint32_t near_face = 0, far_face = 0;
};
// The part of the ray's line inside the box [-half, half]; the faces belong to it.
inline bool clip_to_box(const Vec3& half, const LocalRay& ray, BoxSpan& span) {
  span = {};
  for (int axis = 0; axis < 3; ++axis) {
    const double o = ray.origin[axis], d = ray.direction[axis];
    if (d == 0.0) {
      if (std::abs(o) > half[axis]) return false;
      continue;
    }
    const bool is_upward = d > 0.0;
    const double enter = ((is_upward ? -half[axis] : half[axis]) - o) / d;
    const double leave = ((is_upward ? half[axis] : -half[axis]) - o) / d;
    const auto base = static_cast<uint32_t>(2 * axis);
    if (enter > span.near) span.near = enter, span.near_face = base + (is_upward ? 0 : 1);
    if (leave < span.far) span.far = leave, span.far_face = base + (is_upward ? 1 : 0);
  }
  return span.near <= span.far;
}

// The box [-half, half] by its three slabs. An edge belongs to its box, and a ray in the seam of two boxes meets one:
// what misses by less than the rounding of its numbers hits. Wider quotients alone (Ize 2013) do not allow for the
// rounding of the origin, which a ray nearly along a face magnifies. left_face: the face the origin lies on, or kNone.
// rounding(): how far the faces may be off, by axis; asked for only where the exact box is missed.
template <class IsAhead, class Rounding>
bool intersect_box(const Vec3& half, const LocalRay& ray, uint32_t left_face, const IsAhead& is_ahead,
                   const Rounding& rounding, double& t, uint32_t& face) {
  if (left_face != kNone) {
    const int axis = static_cast<int>(left_face / 2);
    const bool is_outward = left_face % 2 ? ray.direction[axis] >= 0.0 : ray.direction[axis] <= 0.0;
    if (is_outward || half[axis] == 0.0) return false;
  }
  BoxSpan span;
  if (!clip_to_box(half, ray, span) && !clip_to_box(half + rounding(), ray, span)) return false;
  const bool from_outside = left_face == kNone && is_ahead(span.near, span.near_face);
  t = from_outside ? span.near : span.far;
  face = from_outside ? span.near_face : span.far_face;
  return from_outside || is_ahead(span.far, span.far_face);
}

// The plane y = 0.
template <class IsAhead>
bool intersect_plane(const LocalRay& ray, bool has_left, const IsAhead& is_ahead, double& t) {
  if (has_left || ray.direction.y == 0.0) return false;
  t = -ray.origin.y / ray.direction.y;
  return is_ahead(t, 0);
}

// Watertight triangle test in double (Woop, Benthin and Wald 2013, JCGT 2(1)): the triangle is sheared so that the ray
// is the z axis, and three edge functions decide. They are antisymmetric bit for bit, so a ray between two triangles
// hits at least one; an edge value of 0 counts as inside for both, and the lower id wins.
struct Shear {
  int kx = 0, ky = 1, kz = 2;
  double sx = 0.0, sy = 0.0, sz = 1.0;

  static int axis_of(double x, double y, double z) { return x >= y && x >= z ? 0 : y >= z ? 1 : 2; }
  explicit Shear(const Vec3& d) {
    kz = axis_of(std::abs(d.x), std::abs(d.y), std::abs(d.z));
    kx = (kz + 1) % 3, ky = (kz + 2) % 3;
    sz = 1.0 / d[kz];
    sx = d[kx] * sz, sy = d[ky] * sz;
  }
};

struct TriangleHit {
  double t, b0, b1;
};
// with_its_plane: a ray that misses the triangle is answered by the triangle's plane.
inline bool intersect_triangle(const Vec3& v0, const Vec3& v1, const Vec3& v2, const Vec3& origin, const Shear& s,
                               TriangleHit& hit, bool with_its_plane = false) {
  const Vec3 a = v0 - origin, b = v1 - origin, c = v2 - origin;
  const double ax = a[s.kx] - s.sx * a[s.kz], ay = a[s.ky] - s.sy * a[s.kz];
  const double bx = b[s.kx] - s.sx * b[s.kz], by = b[s.ky] - s.sy * b[s.kz];
  const double cx = c[s.kx] - s.sx * c[s.kz], cy = c[s.ky] - s.sy * c[s.kz];
  const double u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
  if (!with_its_plane && (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) return false;
  const double det = u + v + w;
  if (det == 0.0) return false;  // seen edge on: no area
  const double scale = 1.0 / det;
  hit.t = (u * a[s.kz] + v * b[s.kz] + w * c[s.kz]) * s.sz * scale;
  hit.b0 = u * scale;
  hit.b1 = v * scale;
  return true;
}

}  // namespace tilelight
