// SPDX-License-Identifier: Apache-2.0
// Traversal of the 8-wide trees by single rays: boxes and triangles pass a float filter eight at a time, and what is
// left is decided in double (intersect.h). The filter errs on the side of passing, so the image does not depend on it,
// nor on the order of traversal, nor on the instruction set.
#include "renderer/trace/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/trace/trace_rays_simd.cpp"
#include <hwy/foreach_target.h>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "renderer/compile/compiled_scene.h"
#include "renderer/shade/ray.h"
#include "renderer/trace/intersect.h"
#include "renderer/trace/trace_rays.h"

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using FloatTag = hn::CappedTag<float, 8>;

// A ray as the filters see it: float, in a normalised space, its origin moved along the ray to within a few units of
// that space's centre, so that its rounding is about 2^-23 however far the eye is.
struct FilterRay {
  float origin[3], direction[3], inverse[3];
  int near_side[3];    // 0: enters by the lower plane
  float t_min, t_max;  // in units of the space, from the moved origin
  double shift;        // the moved origin lies at this t
  double length;       // of a unit of t in the space
  Vec3 moved;          // the moved origin, exact
};

// Distances in the filter are widened by this before they discard anything: more than their rounding.
inline constexpr float kFilterSlack = 0x1p-18f;

HWY_INLINE float filter_t_max(double t, double shift, double length) {
  const double local = (t - shift) * length;
  if (!(local < 1e30)) return 1e30f;
  return static_cast<float>(local) + kFilterSlack * (1.0f + std::abs(static_cast<float>(local)));
}

HWY_INLINE FilterRay make_filter_ray(const LocalRay& ray, double t_min, double t_max) {
  FilterRay f;
  const double d2 = glm::dot(ray.direction, ray.direction);
  f.length = std::sqrt(d2);
  constexpr double kNear2 = 4.0;  // inside two units of the centre the origin may stay
  f.shift = glm::dot(ray.origin, ray.origin) > kNear2 ? -glm::dot(ray.origin, ray.direction) / d2 : 0.0;
  f.moved = ray.origin + f.shift * ray.direction;
  const double scale = 1.0 / f.length;
  for (int axis = 0; axis < 3; ++axis) {
    f.origin[axis] = static_cast<float>(f.moved[axis]);
    float d = static_cast<float>(ray.direction[axis] * scale);
    f.near_side[axis] = d < 0.0f;
    f.direction[axis] = d;
    // A zero would make 0 * inf; the widened boxes allow for a slope this small.
    constexpr float kTiny = 0x1p-60f;
    if (std::abs(d) < kTiny) d = d < 0.0f ? -kTiny : kTiny;
    f.inverse[axis] = 1.0f / d;
  }
  const double local_min = (t_min - f.shift) * f.length;
  f.t_min = local_min < -1e30
                ? -1e30f
                : static_cast<float>(local_min) - kFilterSlack * (1.0f + std::abs(static_cast<float>(local_min)));
  f.t_max = filter_t_max(t_max, f.shift, f.length);
  return f;
}

struct StackEntry {
  uint32_t node;
  float t;
};
// Eight entries a level of a tree that is at most 66 levels deep (bvh.cpp).
inline constexpr int kStackSize = 8 * 68;

// The children of a node whose boxes the ray meets, the nearest last (to be popped first).
HWY_INLINE int push_children(const WideBvh& bvh, uint32_t index, const FilterRay& ray, float t_max, StackEntry* stack,
                             int top) {
  const WideBvh::Node& node = bvh.nodes[index];
  const FloatTag tag;
  constexpr size_t kLanes = hn::MaxLanes(tag);
  const auto ox = hn::Set(tag, ray.origin[0]), oy = hn::Set(tag, ray.origin[1]), oz = hn::Set(tag, ray.origin[2]);
  const auto ix = hn::Set(tag, ray.inverse[0]), iy = hn::Set(tag, ray.inverse[1]), iz = hn::Set(tag, ray.inverse[2]);
  HWY_ALIGN float entry[WideBvh::kWidth];
  uint32_t mask = 0;
  for (size_t i = 0; i < WideBvh::kWidth; i += kLanes) {
    const auto plane = [&](int side, int axis) HWY_ATTR { return hn::Load(tag, node.bounds[side][axis] + i); };
    const auto nx = hn::Mul(hn::Sub(plane(ray.near_side[0], 0), ox), ix);
    const auto ny = hn::Mul(hn::Sub(plane(ray.near_side[1], 1), oy), iy);
    const auto nz = hn::Mul(hn::Sub(plane(ray.near_side[2], 2), oz), iz);
    const auto fx = hn::Mul(hn::Sub(plane(1 - ray.near_side[0], 0), ox), ix);
    const auto fy = hn::Mul(hn::Sub(plane(1 - ray.near_side[1], 1), oy), iy);
    const auto fz = hn::Mul(hn::Sub(plane(1 - ray.near_side[2], 2), oz), iz);
    const auto near = hn::Max(hn::Max(nx, ny), hn::Max(nz, hn::Set(tag, ray.t_min)));
    const auto far = hn::Min(hn::Min(fx, fy), hn::Min(fz, hn::Set(tag, t_max)));
    hn::Store(near, tag, entry + i);
    uint8_t bits[8] = {};
    hn::StoreMaskBits(tag, hn::Le(near, far), bits);
    mask |= static_cast<uint32_t>(bits[0]) << i;
  }
  const int first = top;
  while (mask != 0) {
    const int c = hwy::Num0BitsBelowLS1Bit_Nonzero32(mask);
    mask &= mask - 1;
    const StackEntry e{node.child[c], entry[c]};
    if (!(e.node & WideBvh::kLeafBit)) hwy::Prefetch(&bvh.nodes[e.node]);
    int place = top++;
    for (; place > first && stack[place - 1].t < e.t; --place) stack[place] = stack[place - 1];
    stack[place] = e;
  }
  return top;
}

// The triangles of a block that may be hit between t_min and t_max, as a bit mask.
struct FilterShear {
  int kx, ky, kz;
  float sx, sy, sz;
};
HWY_INLINE uint32_t filter_triangles(const TriangleBlock& block, const FilterRay& ray, const FilterShear& s,
                                     float t_max) {
  const FloatTag tag;
  constexpr size_t kLanes = hn::MaxLanes(tag);
  using V = hn::Vec<FloatTag>;
  const V ox = hn::Set(tag, ray.origin[s.kx]), oy = hn::Set(tag, ray.origin[s.ky]), oz = hn::Set(tag, ray.origin[s.kz]);
  const V sx = hn::Set(tag, s.sx), sy = hn::Set(tag, s.sy), sz = hn::Set(tag, s.sz);
  // Points in the sheared plane are off by less than this (rounding of origin, direction, vertex and products).
  const V slack = hn::Set(tag, 0x1p-19f);
  uint32_t mask = 0;
  for (size_t i = 0; i < 8; i += kLanes) {
    V x[3], y[3], t[3];
    for (int v = 0; v < 3; ++v) {
      const V z = hn::Sub(hn::Load(tag, block.vertex[v][s.kz] + i), oz);
      x[v] = hn::Sub(hn::Sub(hn::Load(tag, block.vertex[v][s.kx] + i), ox), hn::Mul(sx, z));
      y[v] = hn::Sub(hn::Sub(hn::Load(tag, block.vertex[v][s.ky] + i), oy), hn::Mul(sy, z));
      t[v] = hn::Mul(sz, z);
    }
    auto some_positive = hn::MaskFromVec(hn::Zero(tag)), some_negative = some_positive;
    for (int e = 0; e < 3; ++e) {
      const int a = (e + 1) % 3, b = (e + 2) % 3;
      const V edge = hn::Sub(hn::Mul(x[b], y[a]), hn::Mul(y[b], x[a]));
      const V bound =
          hn::Mul(slack, hn::Add(hn::Add(hn::Abs(x[a]), hn::Abs(y[a])), hn::Add(hn::Abs(x[b]), hn::Abs(y[b]))));
      some_positive = hn::Or(some_positive, hn::Gt(edge, bound));
      some_negative = hn::Or(some_negative, hn::Lt(edge, hn::Neg(bound)));
    }
    // The hit's t lies between those of the vertices.
    const V nearest = hn::Min(t[0], hn::Min(t[1], t[2])), farthest = hn::Max(t[0], hn::Max(t[1], t[2]));
    const auto in_reach = hn::And(hn::Le(nearest, hn::Set(tag, t_max)), hn::Ge(farthest, hn::Set(tag, ray.t_min)));
    const auto maybe = hn::AndNot(hn::And(some_positive, some_negative), in_reach);
    uint8_t bits[8] = {};
    hn::StoreMaskBits(tag, maybe, bits);
    mask |= static_cast<uint32_t>(bits[0]) << i;
  }
  return mask;
}

// Walks one ray through the scene. kAnyHit: stops at the first hit before t_max, for opaque shadows.
template <bool kAnyHit>
class Walk {
 public:
  Walk(const CompiledScene& scene, const BoundedRay& bounded)
      : scene_(scene), ray_(bounded.ray), start_(start_of(bounded.ray)) {
    best_.t = bounded.t_max;
  }

  Hit run() {
    for (size_t i = scene_.finite_bodies; i < scene_.bodies.size(); ++i) {
      if (visit_body(static_cast<uint32_t>(i)) && kAnyHit) return best_;
    }
    if (scene_.tree.nodes.empty()) return best_;
    const FilterRay filter = make_filter_ray({ray_.origin, ray_.direction}, -start_.reach, best_.t);
    StackEntry stack[kStackSize];
    int top = 1;
    stack[0] = {0, filter.t_min};
    float t_max = filter.t_max;
    while (top > 0) {
      const StackEntry e = stack[--top];
      if (e.t > t_max) continue;
      if (!(e.node & WideBvh::kLeafBit)) {
        top = push_children(scene_.tree, e.node, filter, t_max, stack, top);
        continue;
      }
      const WideBvh::Leaf& leaf = scene_.tree.leaves[e.node & ~WideBvh::kLeafBit];
      if (visit_body(scene_.tree.order[leaf.first])) {
        if (kAnyHit) return best_;
        t_max = filter_t_max(best_.t, filter.shift, filter.length);
      }
    }
    return best_;
  }

  Hit run_body(uint32_t index) {
    visit_body(index);
    return best_;
  }

 private:
  // True if the body gave a nearer hit.
  bool visit_body(uint32_t index) {
    const CompiledBody& body = scene_.bodies[index];
    const LocalRay local = to_local(body, ray_);
    const bool has_left = ray_.left.body == index;
    const auto is_ahead = [&](double at, uint32_t of) { return this->is_ahead(index, local, of, at); };
    double t = 0.0;
    uint32_t prim = 0;
    switch (body.kind) {
      case BodyKind::mesh:
        return visit_mesh(index, *body.mesh, local);
      case BodyKind::sphere:
        if (!intersect_sphere(local, has_left, is_ahead, t)) return false;
        break;
      case BodyKind::box:
        if (!intersect_box(body.half, local, has_left ? ray_.left.prim : kNone, is_ahead, t, prim)) return false;
        break;
      case BodyKind::plane:
        if (!intersect_plane(local, has_left, is_ahead, t)) return false;
        break;
    }
    return offer(index, prim, t, 0.0, 0.0);
  }

  // Whether a hit lies ahead of the start. Where the start itself lies on the surface that is hit, the order of ids
  // decides and not the sign of t.
  bool is_ahead(uint32_t index, const LocalRay& local, uint32_t prim, double t) const {
    if (t > start_.reach) return true;
    if (!(t >= -start_.reach) || start_.noise == 0.0) return false;
    const CompiledBody& body = scene_.bodies[index];
    if (std::abs(t) * steepness(body, local, ray_.direction, prim, t) > start_.noise) return t > 0.0;
    if (index == ray_.left.body || ray_.coincident == Coincident::none) return false;
    return (body.body > scene_.bodies[ray_.left.body].body) == (ray_.coincident == Coincident::after);
  }

  bool offer(uint32_t index, uint32_t prim, double t, double b0, double b1) {
    if (best_.is_hit() ? !is_nearer(index, prim, t) : !(t < best_.t)) return false;
    best_ = {t, index, prim, b0, b1};
    return true;
  }

  // Two surfaces nearer to each other than rounding can tell, measured across them, are in one place, which the lower
  // id wins: coplanar surfaces show one colour everywhere.
  bool is_nearer(uint32_t index, uint32_t prim, double t) const {
    const double noise = 0x1p-46 * (1.0 + std::abs(t));
    const double gap = std::abs(t - best_.t);
    if (gap > 0x1p20 * noise) return t < best_.t;
    if (gap > noise) {
      const double slope = std::max(steepness_at(index, prim, t), steepness_at(best_.body, best_.prim, best_.t));
      if (gap * slope > noise) return t < best_.t;
    }
    const uint32_t body = scene_.bodies[index].body, best_body = scene_.bodies[best_.body].body;
    return body != best_body ? body < best_body : prim < best_.prim;
  }

  double steepness_at(uint32_t index, uint32_t prim, double t) const {
    const CompiledBody& body = scene_.bodies[index];
    return steepness(body, to_local(body, ray_), ray_.direction, prim, t);
  }

  bool visit_mesh(uint32_t index, const CompiledMesh& mesh, const LocalRay& local) {
    if (mesh.bvh.nodes.empty()) return false;
    const FilterRay filter = make_filter_ray(local, -start_.reach, best_.t);
    const Shear shear(local.direction);
    const FilterShear filter_shear{shear.kx,
                                   shear.ky,
                                   shear.kz,
                                   static_cast<float>(shear.sx),
                                   static_cast<float>(shear.sy),
                                   static_cast<float>(shear.sz * filter.length)};
    StackEntry stack[kStackSize];
    int top = 1;
    stack[0] = {0, filter.t_min};
    float t_max = filter.t_max;
    bool found = false;
    while (top > 0) {
      const StackEntry e = stack[--top];
      if (e.t > t_max) continue;
      if (!(e.node & WideBvh::kLeafBit)) {
        top = push_children(mesh.bvh, e.node, filter, t_max, stack, top);
        continue;
      }
      const TriangleBlock& block = mesh.blocks[e.node & ~WideBvh::kLeafBit];
      uint32_t candidates = filter_triangles(block, filter, filter_shear, t_max);
      while (candidates != 0) {
        const int lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(candidates);
        candidates &= candidates - 1;
        if (!offer_triangle(index, mesh, local, block.id[lane], filter, shear)) continue;
        if (kAnyHit) return true;
        found = true;
        t_max = filter_t_max(best_.t, filter.shift, filter.length);
      }
    }
    return found;
  }

  bool offer_triangle(uint32_t index, const CompiledMesh& mesh, const LocalRay& local, uint32_t id,
                      const FilterRay& filter, const Shear& shear) {
    if (ray_.left.body == index && ray_.left.prim == id) return false;
    const auto& tri = mesh.triangles[id];
    TriangleHit hit;
    if (!intersect_triangle(mesh.positions[tri[0]], mesh.positions[tri[1]], mesh.positions[tri[2]], filter.moved, shear,
                            hit)) {
      return false;
    }
    const double t = filter.shift + hit.t;
    return is_ahead(index, local, id, t) && offer(index, id, t, hit.b0, hit.b1);
  }

  const CompiledScene& scene_;
  const Ray& ray_;
  const Start start_;
  Hit best_;
};

void trace_closest_rays(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<Hit> hits) {
  for (size_t i = 0; i < rays.size(); ++i) hits[i] = Walk<false>(scene, rays[i]).run();
}

void trace_any_rays(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<uint8_t> is_blocked) {
  for (size_t i = 0; i < rays.size(); ++i) is_blocked[i] = Walk<true>(scene, rays[i]).run().is_hit();
}

void trace_body_ray(const CompiledScene& scene, uint32_t body, const Ray& ray, Hit& hit) {
  hit = Walk<false>(scene, {ray}).run_body(body);
}

}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tilelight {

HWY_EXPORT(trace_closest_rays);
HWY_EXPORT(trace_any_rays);
HWY_EXPORT(trace_body_ray);

void trace_closest(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<Hit> hits) {
  HWY_DYNAMIC_DISPATCH(trace_closest_rays)(scene, rays, hits);
}

void trace_any(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<uint8_t> is_blocked) {
  HWY_DYNAMIC_DISPATCH(trace_any_rays)(scene, rays, is_blocked);
}

Hit trace_body(const CompiledScene& scene, uint32_t body, const Ray& ray) {
  Hit hit;
  HWY_DYNAMIC_DISPATCH(trace_body_ray)(scene, body, ray, hit);
  return hit;
}

}  // namespace tilelight
#endif
