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

#include "renderer/compile/built_in.h"
#include "renderer/compile/compiled_scene.h"
#include "renderer/shade/ray.h"
#include "renderer/trace/intersect.h"
#include "renderer/trace/trace_rays.h"

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using FloatTag = hn::CappedTag<float, 8>;

// A ray as the filters see it: float, in the world or in a mesh's normalised space, its origin moved along the ray to
// within a few units of that space's centre, so that its rounding is about 2^-23 however far the eye is.
struct FilterRay {
  float origin[3], direction[3], inverse[3];
  float near_origin[3], far_origin[3];  // origin, moved by its own uncertainty so that no box that is met is missed
  float slack;                          // points in a plane sheared by slopes up to 1 are off by less
  int near_side[3];                     // 0: enters by the lower plane
  float t_min, t_max;                   // in units of the space, from the moved origin
  double shift;                         // the moved origin lies at this t
  double length;                        // of a unit of t in the space
  Vec3 moved;                           // the moved origin, exact
};

// Distances in the filter are widened by this before they discard anything: more than their rounding.
inline constexpr float kFilterSlack = 0x1p-18f;
// Points in a plane sheared by slopes up to 1 are off by less than this. In units of 2^-25: 6 for vertex and
// origin, 13.5 for each unit of the distance along the ray (8 of the slope, which is rounded four times, 4 of
// differences, 2 of the product), of which there are no more than 3, and 6 for each unit of |x| + |y|, no more than 8,
// with the rounding of the edge functions: 94.5. What is discarded and what is accepted both rest on it.
inline constexpr float kSheared = 96.0f * 0x1p-25f;
// A slope of 0 would make 0 * inf; the widened boxes allow for one this small.
inline constexpr float kTinySlope = 0x1p-60f;

HWY_INLINE float filter_t_max(double t, double shift, double length) {
  const double local = (t - shift) * length;
  if (!(local < 1e30)) return 1e30f;
  return static_cast<float>(local) + kFilterSlack * (1.0f + std::abs(static_cast<float>(local)));
}

// How far a ray's line in the world may lie from the same line in some body's space, where what is found is decided:
// roundings of the origin in double, times how uneven a merged body's placement may be (find_merged).
HWY_INLINE double strayed(const Vec3& origin) {
  constexpr double kEverywhere = 1e3;
  return std::min(0x1p-40 * std::max({std::abs(origin.x), std::abs(origin.y), std::abs(origin.z)}), kEverywhere);
}

HWY_INLINE FilterRay make_filter_ray(const LocalRay& ray, double off, double t_min, double t_max) {
  FilterRay f;
  f.slack = kSheared + 2.0f * static_cast<float>(off);
  f.length = std::sqrt(glm::dot(ray.direction, ray.direction));
  f.moved = moved_origin(ray, f.shift);
  const double scale = 1.0 / f.length;
  for (int axis = 0; axis < 3; ++axis) {
    f.origin[axis] = static_cast<float>(f.moved[axis]);
    float d = static_cast<float>(ray.direction[axis] * scale);
    f.near_side[axis] = d < 0.0f;
    f.direction[axis] = d;
    const float back = d < 0.0f ? -static_cast<float>(off) : static_cast<float>(off);
    f.near_origin[axis] = f.origin[axis] + back, f.far_origin[axis] = f.origin[axis] - back;
    if (std::abs(d) < kTinySlope) d = d < 0.0f ? -kTinySlope : kTinySlope;
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
// Eight entries a level of a tree that is at most 66 levels deep (compile/bvh_binary.cpp).
inline constexpr int kStackSize = 8 * 68;

// A node that a walk will open, which lies in four lines of the cache.
HWY_INLINE void prefetch(const TriangleTree& tree, uint32_t reference) {
  if (reference & WideBvh::kLeafBit) return;
  const auto* node = reinterpret_cast<const char*>(&tree.nodes[reference]);
  for (size_t line = 0; line < sizeof(WideBvh::Node); line += 64) hwy::Prefetch(node + line);
}

// The children of a node whose boxes the ray meets, the nearest last (to be popped first).
HWY_INLINE int push_children(const TriangleTree& tree, uint32_t index, const FilterRay& ray, float t_max,
                             StackEntry* stack, int top) {
  const WideBvh::Node& node = tree.nodes[index];
  const FloatTag tag;
  constexpr size_t kLanes = hn::MaxLanes(tag);
  const auto ox = hn::Set(tag, ray.near_origin[0]), oy = hn::Set(tag, ray.near_origin[1]),
             oz = hn::Set(tag, ray.near_origin[2]);
  const auto px = hn::Set(tag, ray.far_origin[0]), py = hn::Set(tag, ray.far_origin[1]),
             pz = hn::Set(tag, ray.far_origin[2]);
  const auto ix = hn::Set(tag, ray.inverse[0]), iy = hn::Set(tag, ray.inverse[1]), iz = hn::Set(tag, ray.inverse[2]);
  HWY_ALIGN float entry[WideBvh::kWidth];
  uint32_t mask = 0;
  for (size_t i = 0; i < WideBvh::kWidth; i += kLanes) {
    const auto plane = [&](int side, int axis) HWY_ATTR { return hn::Load(tag, node.bounds[side][axis] + i); };
    const auto nx = hn::Mul(hn::Sub(plane(ray.near_side[0], 0), ox), ix);
    const auto ny = hn::Mul(hn::Sub(plane(ray.near_side[1], 1), oy), iy);
    const auto nz = hn::Mul(hn::Sub(plane(ray.near_side[2], 2), oz), iz);
    const auto fx = hn::Mul(hn::Sub(plane(1 - ray.near_side[0], 0), px), ix);
    const auto fy = hn::Mul(hn::Sub(plane(1 - ray.near_side[1], 1), py), iy);
    const auto fz = hn::Mul(hn::Sub(plane(1 - ray.near_side[2], 2), pz), iz);
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
    prefetch(tree, e.node);
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
  const V slack = hn::Set(tag, ray.slack);
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

// Walks one ray through the scene. kAnyHit: stops at the first hit before t_max, for opaque shadows.
template <bool kAnyHit>
class Walk {
 public:
  Walk(const CompiledScene& scene, const BoundedRay& bounded)
      : scene_(scene), ray_(bounded.ray), start_(start_of(bounded.ray)), t_max_(bounded.t_max) {
    best_.t = bounded.t_max;
  }

  Hit run() {
    visit_all();
    if (kAnyHit || !has_tie_) return best_;
    // Something lies in the same place as the nearest hit, or nearly: among those the lowest rank wins, whatever the
    // order in which they are met; the highest on the way back through films.
    front_ = best_;
    goes_back_ = ray_.coincident == Coincident::before && lies_at_start(scene_, ray_, front_);
    visit_all();
    return best_;
  }

  // The nearest hit with one body alone.
  Hit run_body(uint32_t index) {
    only_ = index;
    const CompiledBody& body = scene_.bodies[index];
    if (body.kind == BodyKind::mesh && !body.tree) {
      visit_tree(scene_.tree, kNone, world());
    } else {
      visit_body(index);
    }
    return best_;
  }

  // The nearest hit with a sphere, box or plane that lies ahead, whatever else is there.
  bool meet_solid(uint32_t index, double& t, uint32_t& prim) const {
    const CompiledBody& body = scene_.bodies[index];
    const LocalRay local = to_local(body, ray_);
    const bool has_left = ray_.left.body == index;
    const auto is_ahead = [&](double at, uint32_t of) { return this->is_ahead(index, local, of, at); };
    prim = 0;
    switch (body.kind) {
      case BodyKind::sphere:
        if (!is_built_in(Feature::spheres)) break;
        return intersect_sphere(local, has_left, is_ahead, t);
      case BodyKind::box:
        if (!is_built_in(Feature::boxes)) break;
        return intersect_box(
            body.half, local, has_left ? ray_.left.prim : kNone, is_ahead, [&] { return local_rounding(body, ray_); },
            t, prim);
      case BodyKind::plane:
        if (!is_built_in(Feature::planes)) break;
        return intersect_plane(local, has_left, is_ahead, t);
      case BodyKind::mesh:
        break;
    }
    return false;
  }

  // The ray in the space of a mesh, as the exact test of triangles takes it.
  struct Inside {
    uint32_t body = kNone;
    LocalRay local;
    Vec3 moved{0.0};
    double shift = 0.0;
    Shear shear{Vec3(0.0, 0.0, 1.0)};
  };
  Inside inside(uint32_t index) const {
    Inside in;
    in.body = index;
    in.local = to_local(scene_.bodies[index], ray_);
    in.moved = moved_origin(in.local, in.shift);
    in.shear = Shear(in.local.direction);
    return in;
  }

  // Whether the ray meets a triangle ahead; it is not the one that it has left.
  bool meet_triangle(const Inside& in, uint32_t id, Hit& hit) const {
    const CompiledMesh& mesh = *scene_.bodies[in.body].mesh;
    const auto& tri = mesh.triangles[id];
    TriangleHit found;
    if (!intersect_triangle(mesh.positions[tri[0]], mesh.positions[tri[1]], mesh.positions[tri[2]], in.moved, in.shear,
                            found))
      return false;
    hit = {in.shift + found.t, in.body, id, found.b0, found.b1};
    return is_ahead(in.body, in.local, id, hit.t);
  }

 private:
  bool is_settling() const { return front_.is_hit(); }
  // Nothing from here on is asked for.
  double end() const { return is_settling() ? end_of_ties(front_.t) : best_.is_hit() ? end_of_ties(best_.t) : best_.t; }

  FilterRay world() const {
    return make_filter_ray({ray_.origin, ray_.direction}, strayed(ray_.origin), -start_.reach, end());
  }

  void visit_all() {
    for (size_t i = scene_.finite_bodies; i < scene_.bodies.size(); ++i) {
      if (visit_body(static_cast<uint32_t>(i)) && kAnyHit) return;
    }
    visit_tree(scene_.tree, kNone, world());
  }

  // True if the body gave a nearer hit. Merged meshes are met in the scene's tree.
  bool visit_body(uint32_t index) {
    const CompiledBody& body = scene_.bodies[index];
    if (is_built_in(Feature::triangles) && body.kind == BodyKind::mesh)
      return visit_tree(*body.tree, index, make_filter_ray(to_local(body, ray_), 0.0, -start_.reach, end()));
    double t = 0.0;
    uint32_t prim = 0;
    if (!meet_solid(index, t, prim)) return false;
    return offer({t, index, prim, 0.0, 0.0});
  }

  // Walks a tree in whose space the filter lies: the scene's (owner kNone), or that of the owner's mesh. True if there
  // was a nearer hit; for any hit it ends there.
  bool visit_tree(const TriangleTree& tree, uint32_t owner, const FilterRay& filter) {
    if (tree.nodes.empty()) return false;
    const FilterShear shear(filter);
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
        top = push_children(tree, e.node, filter, t_max, stack, top);
        continue;
      }
      const uint32_t leaf = e.node & ~WideBvh::kLeafBit;
      const bool is_nearer = !is_built_in(Feature::triangles) || leaf & TriangleTree::kBodyBit
                                 ? only_ == kNone && visit_body(leaf & ~TriangleTree::kBodyBit)
                                 : visit_block(tree.blocks[leaf], owner, filter, shear, t_sure, t_max);
      if (!is_nearer) continue;
      if (kAnyHit) return true;
      found = true;
      t_max = filter_t_max(end(), filter.shift, filter.length);
    }
    return found;
  }

  bool visit_block(const TriangleBlock& block, uint32_t owner, const FilterRay& filter, const FilterShear& shear,
                   float t_sure, float t_max) {
    const Sifted sifted = sift_triangles<kAnyHit>(block, filter, shear, t_sure, t_max);
    bool found = false;
    for (uint32_t lanes = sifted.maybe; lanes != 0; lanes &= lanes - 1) {
      const int lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(lanes);
      const uint32_t body = owner == kNone ? block.body[lane] : owner, prim = block.prim[lane];
      if ((ray_.left.body == body && ray_.left.prim == prim) || (only_ != kNone && only_ != body)) continue;
      if (kAnyHit && (sifted.surely >> lane & 1) != 0) {  // that there is a hit, not where
        best_.body = body;
        return true;
      }
      if (inside_.body != body) inside_ = inside(body);
      Hit hit;
      if (!meet_triangle(inside_, prim, hit) || !offer(hit)) continue;
      if (kAnyHit) return true;
      found = true;
    }
    return found;
  }

  // Whether a hit lies ahead of the start. Where the start itself lies on the surface that is hit, the order of layers
  // decides and not the sign of t.
  bool is_ahead(uint32_t index, const LocalRay& local, uint32_t prim, double t) const {
    if (t > start_.reach) return true;
    if (!(t >= -start_.reach) || start_.noise == 0.0) return false;
    const CompiledBody& body = scene_.bodies[index];
    const double noise = start_.noise + face_rounding(body, scene_.bodies[ray_.left.body]);
    if (std::abs(t) * steepness(body, local, ray_.direction, prim, t) > noise) return t > 0.0;
    return is_met_at_start(scene_, ray_, index);
  }

  // Surfaces up to here may lie in the same place as one at t, see is_nearer.
  static double tie_at(double t) { return 0x1p-26 * (1.0 + std::abs(t)); }
  static double end_of_ties(double t) { return t + 0x1p-25 * (1.0 + std::abs(t)); }

  bool offer(const Hit& hit) {
    const double t = hit.t;
    if (is_settling()) {
      if (comes_before(hit, best_) && t < t_max_ && are_in_one_place(hit, front_)) best_ = hit;
      return false;
    }
    if (best_.is_hit()) {
      const bool is_tied = std::abs(t - best_.t) <= tie_at(std::max(std::abs(t), std::abs(best_.t)));
      if (t < best_.t || (t == best_.t && comes_before(hit, best_))) {
        has_tie_ = is_tied;
      } else {
        has_tie_ |= is_tied;
        return false;
      }
    } else if (!(t < best_.t)) {
      return false;
    }
    best_ = hit;
    return true;
  }

  bool comes_before(const Hit& a, const Hit& b) const {
    const uint32_t rank_a = scene_.bodies[a.body].rank, rank_b = scene_.bodies[b.body].rank;
    if (rank_a != rank_b) return goes_back_ ? rank_a > rank_b : rank_a < rank_b;
    return a.prim < b.prim;
  }

  // Whether rounding can tell two surfaces apart, measured across them. If not they are in one place, which the lower
  // rank wins: coplanar surfaces show one colour everywhere.
  bool are_in_one_place(const Hit& a, const Hit& b) const {
    const double gap = std::abs(a.t - b.t), size = std::max(std::abs(a.t), std::abs(b.t));
    if (gap > tie_at(size)) return false;
    if (gap <= 0x1p-46 * size) return true;
    const CompiledBody &body_a = scene_.bodies[a.body], &body_b = scene_.bodies[b.body];
    const double noise =
        0x1p-46 * (std::max(reach_of(body_a), reach_of(body_b)) + size) + face_rounding(body_a, body_b);
    if (gap > 0x1p20 * noise) return false;
    return gap <= noise || gap * std::max(steepness_at(a), steepness_at(b)) <= noise;
  }

  // How far a body reaches from the scene's centre: its place is rounded relative to this.
  static double reach_of(const CompiledBody& body) {
    if (body.kind == BodyKind::plane) return 1.0;
    const Vec3 half = body.kind == BodyKind::box ? body.half : Vec3(1.0);
    Vec3 reach = glm::abs(Vec3(body.world_from_local[3]));
    for (int column = 0; column < 3; ++column) reach += half[column] * glm::abs(Vec3(body.world_from_local[column]));
    return std::max({reach.x, reach.y, reach.z});
  }

  double steepness_at(const Hit& hit) const {
    const CompiledBody& body = scene_.bodies[hit.body];
    return steepness(body, to_local(body, ray_), ray_.direction, hit.prim, hit.t);
  }

  const CompiledScene& scene_;
  const Ray& ray_;
  const Start start_;
  const double t_max_;
  Hit best_;
  Hit front_;               // while ties are settled: the nearest hit
  bool goes_back_ = false;  // and the ray starts there, on its way back
  bool has_tie_ = false;    // another hit may be in the same place as the best
  uint32_t only_ = kNone;   // the one body that is asked for
  Inside inside_;           // of the mesh that was asked last
};

}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#endif
