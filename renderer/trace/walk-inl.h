// SPDX-License-Identifier: Apache-2.0
// Traversal of the 8-wide trees by single rays: boxes and triangles pass a float filter eight at a time, and what is
// left is decided in double (intersect.h). The filter errs on the side of passing, and where any hit will do it accepts
// what its margin puts beyond doubt; so the image depends neither on it nor on the instruction set. Included once for
// every instruction set.
#if defined(TILELIGHT_WALK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TILELIGHT_WALK_INL_H
#undef TILELIGHT_WALK_INL_H
#else
#define TILELIGHT_WALK_INL_H
#endif

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
  if (glm::dot(f.moved, f.moved) > kNear2) {  // so far away that the shift itself was rounded by units: once more
    const double rest = -glm::dot(f.moved, ray.direction) / d2;
    f.shift += rest;
    f.moved += rest * ray.direction;
  }
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

// What the float filter can say of the triangles of a block, as bit masks.
struct Sifted {
  uint32_t maybe = 0;   // may be hit between t_min and t_max
  uint32_t surely = 0;  // of those: hit without any doubt, between t_sure and t_max less its slack; found if kSurely
};
struct FilterShear {
  int kx, ky, kz;
  float sx, sy, sz;

  // As Shear, in float: the axis is that of the longest component, so that no slope exceeds 1.
  explicit FilterShear(const FilterRay& ray) {
    const float x = std::abs(ray.direction[0]), y = std::abs(ray.direction[1]), z = std::abs(ray.direction[2]);
    kz = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    kx = (kz + 1) % 3, ky = (kz + 2) % 3;
    sz = ray.inverse[kz];
    sx = ray.direction[kx] * sz, sy = ray.direction[ky] * sz;
  }
};
template <bool kSurely>
HWY_INLINE Sifted sift_triangles(const TriangleBlock& block, const FilterRay& ray, const FilterShear& s, float t_sure,
                                 float t_max) {
  const FloatTag tag;
  constexpr size_t kLanes = hn::MaxLanes(tag);
  using V = hn::Vec<FloatTag>;
  const V ox = hn::Set(tag, ray.origin[s.kx]), oy = hn::Set(tag, ray.origin[s.ky]), oz = hn::Set(tag, ray.origin[s.kz]);
  const V sx = hn::Set(tag, s.sx), sy = hn::Set(tag, s.sy), sz = hn::Set(tag, s.sz);
  // Points in the sheared plane are off by less than this: 33 roundings of 2^-25 (of origin, direction, vertex, shear
  // and their products) come to 2^-19.9. What is discarded and what is accepted both rest on it.
  const V slack = hn::Set(tag, 0x1p-19f);
  Sifted out;
  for (size_t i = 0; i < 8; i += kLanes) {
    V x[3], y[3], t[3];
    for (int v = 0; v < 3; ++v) {
      const V z = hn::Sub(hn::Load(tag, block.vertex[v][s.kz] + i), oz);
      x[v] = hn::Sub(hn::Sub(hn::Load(tag, block.vertex[v][s.kx] + i), ox), hn::Mul(sx, z));
      y[v] = hn::Sub(hn::Sub(hn::Load(tag, block.vertex[v][s.ky] + i), oy), hn::Mul(sy, z));
      t[v] = hn::Mul(sz, z);
    }
    V edge[3], most = hn::Zero(tag);
    for (int v = 0; v < 3; ++v) {
      const int p = (v + 1) % 3, q = (v + 2) % 3;
      edge[v] = hn::Sub(hn::Mul(x[q], y[p]), hn::Mul(y[q], x[p]));
      most = hn::Max(most, hn::Add(hn::Abs(x[v]), hn::Abs(y[v])));
    }
    // No edge function is off by more than this: four coordinates times the slack.
    const V bound = hn::Mul(hn::Add(slack, slack), most), under = hn::Neg(bound);
    const V least = hn::Min(edge[0], hn::Min(edge[1], edge[2])), greatest = hn::Max(edge[0], hn::Max(edge[1], edge[2]));
    // The hit's t lies between those of the vertices.
    const V nearest = hn::Min(t[0], hn::Min(t[1], t[2])), farthest = hn::Max(t[0], hn::Max(t[1], t[2]));
    const auto in_reach = hn::And(hn::Le(nearest, hn::Set(tag, t_max)), hn::Ge(farthest, hn::Set(tag, ray.t_min)));
    const auto maybe = hn::And(hn::Or(hn::Ge(least, under), hn::Le(greatest, bound)), in_reach);
    uint8_t bits[8] = {};
    hn::StoreMaskBits(tag, maybe, bits);
    out.maybe |= static_cast<uint32_t>(bits[0]) << i;
    if constexpr (kSurely) {
      const float t_end = t_max - 2.0f * kFilterSlack * (1.0f + std::abs(t_max));
      const auto between = hn::And(hn::Gt(nearest, hn::Set(tag, t_sure)), hn::Lt(farthest, hn::Set(tag, t_end)));
      hn::StoreMaskBits(tag, hn::And(hn::Or(hn::Gt(least, bound), hn::Lt(greatest, under)), between), bits);
      out.surely |= static_cast<uint32_t>(bits[0]) << i;
    }
  }
  return out;
}

struct NaiveHit {
  int lane = -1;  // < 0: none
  float t = 0.0f, u = 0.0f, v = 0.0f;
};
HWY_INLINE NaiveHit naive_triangles(const TriangleBlock& block, const FilterRay& ray, float t_min, float t_max) {
  const FloatTag tag;
  constexpr size_t kLanes = hn::MaxLanes(tag);
  using V = hn::Vec<FloatTag>;
  const V dx = hn::Set(tag, ray.direction[0]), dy = hn::Set(tag, ray.direction[1]), dz = hn::Set(tag, ray.direction[2]);
  HWY_ALIGN float t[8], u[8], v[8];
  uint32_t mask = 0;
  for (size_t i = 0; i < 8; i += kLanes) {
    const auto corner = [&](int vertex, int axis) HWY_ATTR { return hn::Load(tag, block.vertex[vertex][axis] + i); };
    const V ax = corner(0, 0), ay = corner(0, 1), az = corner(0, 2);
    const V bx = hn::Sub(corner(1, 0), ax), by = hn::Sub(corner(1, 1), ay), bz = hn::Sub(corner(1, 2), az);
    const V cx = hn::Sub(corner(2, 0), ax), cy = hn::Sub(corner(2, 1), ay), cz = hn::Sub(corner(2, 2), az);
    const auto cross = [](V p, V q, V r, V s) HWY_ATTR { return hn::Sub(hn::Mul(p, q), hn::Mul(r, s)); };
    const auto dot = [](V px, V py, V pz, V qx, V qy, V qz)
                         HWY_ATTR { return hn::Add(hn::Add(hn::Mul(px, qx), hn::Mul(py, qy)), hn::Mul(pz, qz)); };
    const V px = cross(dy, cz, dz, cy), py = cross(dz, cx, dx, cz), pz = cross(dx, cy, dy, cx);
    const V inverse = hn::Div(hn::Set(tag, 1.0f), dot(bx, by, bz, px, py, pz));
    const V sx = hn::Sub(hn::Set(tag, ray.origin[0]), ax), sy = hn::Sub(hn::Set(tag, ray.origin[1]), ay),
            sz = hn::Sub(hn::Set(tag, ray.origin[2]), az);
    const V qx = cross(sy, bz, sz, by), qy = cross(sz, bx, sx, bz), qz = cross(sx, by, sy, bx);
    const V at_u = hn::Mul(dot(sx, sy, sz, px, py, pz), inverse), at_v = hn::Mul(dot(dx, dy, dz, qx, qy, qz), inverse),
            at_t = hn::Mul(dot(cx, cy, cz, qx, qy, qz), inverse);
    const V zero = hn::Zero(tag);
    const auto inside =
        hn::And(hn::And(hn::Ge(at_u, zero), hn::Ge(at_v, zero)), hn::Le(hn::Add(at_u, at_v), hn::Set(tag, 1.0f)));
    const auto in_reach = hn::And(hn::Gt(at_t, hn::Set(tag, t_min)), hn::Lt(at_t, hn::Set(tag, t_max)));
    uint8_t bits[8] = {};
    hn::StoreMaskBits(tag, hn::And(inside, in_reach), bits);
    mask |= static_cast<uint32_t>(bits[0]) << i;
    hn::Store(at_t, tag, t + i), hn::Store(at_u, tag, u + i), hn::Store(at_v, tag, v + i);
  }
  NaiveHit hit;
  for (; mask != 0; mask &= mask - 1) {
    const int lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(mask);
    if (hit.lane < 0 || t[lane] < hit.t) hit = {lane, t[lane], u[lane], v[lane]};
  }
  return hit;
}

// How a leaf decides which of its triangles are hit.
enum class Decide {
  exactly,  // the float filter, then double, watertight
  naively   // Moeller and Trumbore 1997 in float and a fixed epsilon: for benchmarks of what exactness costs
};

// Walks one ray through the scene. kAnyHit: stops at the first hit before t_max, for opaque shadows.
template <bool kAnyHit, Decide kDecide = Decide::exactly>
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
        t_max = filter_t_max(end_of_ties(best_.t), filter.shift, filter.length);
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
        if (!intersect_box(
                body.half, local, has_left ? ray_.left.prim : kNone, is_ahead,
                [&] { return local_rounding(body, ray_); }, t, prim)) {
          return false;
        }
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
    const bool is_before = body.body < scene_.bodies[ray_.left.body].body;
    if (ray_.coincident == Coincident::after) return !is_before;
    // What lies before the surface has let the ray through that came here; something opaque there is rounding.
    return is_before && scene_.materials[body.material].is_transmissive;
  }

  // Surfaces up to here may lie in the same place as one at t, see is_nearer.
  static double end_of_ties(double t) { return t + 0x1p-26 * (1.0 + std::abs(t)); }

  bool offer(uint32_t index, uint32_t prim, double t, double b0, double b1) {
    if (best_.is_hit() ? !is_nearer(index, prim, t) : !(t < best_.t)) return false;
    best_ = {t, index, prim, b0, b1};
    return true;
  }

  // Two surfaces nearer to each other than rounding can tell, measured across them, are in one place, which the lower
  // id wins: coplanar surfaces show one colour everywhere.
  bool is_nearer(uint32_t index, uint32_t prim, double t) const {
    const double gap = std::abs(t - best_.t), size = std::abs(t);
    if (gap > 0x1p-26 * (1.0 + size)) return t < best_.t;  // what nearly all hits are
    if (gap > 0x1p-46 * size) {
      const double reach = std::max(reach_of(scene_.bodies[index]), reach_of(scene_.bodies[best_.body]));
      const double noise = 0x1p-46 * (reach + size);
      if (gap > 0x1p20 * noise) return t < best_.t;
      if (gap > noise) {
        const double slope = std::max(steepness_at(index, prim, t), steepness_at(best_.body, best_.prim, best_.t));
        if (gap * slope > noise) return t < best_.t;
      }
    }
    const uint32_t body = scene_.bodies[index].body, best_body = scene_.bodies[best_.body].body;
    return body != best_body ? body < best_body : prim < best_.prim;
  }

  // How far a body reaches from the scene's centre: its place is rounded relative to this.
  static double reach_of(const CompiledBody& body) {
    if (body.kind == BodyKind::plane) return 1.0;
    const Vec3 half = body.kind == BodyKind::box ? body.half : Vec3(1.0);
    Vec3 reach = glm::abs(Vec3(body.world_from_local[3]));
    for (int column = 0; column < 3; ++column) reach += half[column] * glm::abs(Vec3(body.world_from_local[column]));
    return std::max({reach.x, reach.y, reach.z});
  }

  double steepness_at(uint32_t index, uint32_t prim, double t) const {
    const CompiledBody& body = scene_.bodies[index];
    return steepness(body, to_local(body, ray_), ray_.direction, prim, t);
  }

  bool visit_mesh(uint32_t index, const CompiledMesh& mesh, const LocalRay& local) {
    if (mesh.bvh.nodes.empty()) return false;
    const FilterRay filter = make_filter_ray(local, -start_.reach, best_.t);
    const FilterShear filter_shear(filter);
    // From here on a hit lies ahead without any doubt.
    const float t_sure = filter_t_max(2.0 * start_.reach, filter.shift, filter.length);
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
      if constexpr (kDecide == Decide::naively) {
        if (!offer_naively(index, block, filter, t_max)) continue;
        if (kAnyHit) return true;
        found = true;
        continue;
      }
      const Sifted sifted = sift_triangles<kAnyHit>(block, filter, filter_shear, t_sure, t_max);
      if (kAnyHit && has_sure_hit(index, block, sifted.surely)) return true;
      uint32_t candidates = sifted.maybe;
      while (candidates != 0) {
        const int lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(candidates);
        candidates &= candidates - 1;
        if (!offer_triangle(index, mesh, local, block.id[lane], filter)) continue;
        if (kAnyHit) return true;
        found = true;
        t_max = filter_t_max(end_of_ties(best_.t), filter.shift, filter.length);
      }
    }
    return found;
  }

  // Whether one of the triangles that are surely hit is not the one that the ray has left. Tells that there is a hit
  // and not which: for any hit alone.
  bool has_sure_hit(uint32_t index, const TriangleBlock& block, uint32_t surely) {
    if (surely != 0 && ray_.left.body == index) {
      for (uint32_t lanes = surely; lanes != 0; lanes &= lanes - 1) {
        const int lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(lanes);
        if (block.id[lane] == ray_.left.prim) surely &= ~(1u << lane);
      }
    }
    if (surely == 0) return false;
    best_.body = index;
    return true;
  }

  bool offer_triangle(uint32_t index, const CompiledMesh& mesh, const LocalRay& local, uint32_t id,
                      const FilterRay& filter) {
    if (ray_.left.body == index && ray_.left.prim == id) return false;
    const auto& tri = mesh.triangles[id];
    TriangleHit hit;
    if (!intersect_triangle(mesh.positions[tri[0]], mesh.positions[tri[1]], mesh.positions[tri[2]], filter.moved,
                            Shear(local.direction), hit)) {
      return false;
    }
    const double t = filter.shift + hit.t;
    return is_ahead(index, local, id, t) && offer(index, id, t, hit.b0, hit.b1);
  }

  // The nearest of the block's hits between an epsilon and t_max, which it shortens.
  bool offer_naively(uint32_t index, const TriangleBlock& block, const FilterRay& ray, float& t_max) {
    constexpr float kEpsilon = 1e-4f;
    const NaiveHit hit = naive_triangles(block, ray, static_cast<float>(-ray.shift * ray.length) + kEpsilon, t_max);
    if (hit.lane < 0) return false;
    t_max = hit.t;
    best_ = {ray.shift + hit.t / ray.length, index, block.id[hit.lane], 1.0 - hit.u - hit.v, hit.u};
    return true;
  }

  const CompiledScene& scene_;
  const Ray& ray_;
  const Start start_;
  Hit best_;
};

}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#endif
