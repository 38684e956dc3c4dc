// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/naive_rays.h"

#include <vector>

#include "renderer/base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/bench/naive_rays_simd.cpp"
#include <hwy/foreach_target.h>

#include "renderer/trace/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {

// Moeller and Trumbore 1997 with a fixed epsilon, the nearest t wins, and no doubt.
template <bool kAnyHit>
struct NaiveTriangles {
  struct Edges {
    Edges(const TriangleBlock&, const PacketRays&) {}
  };
  static constexpr bool kInDouble = false;

  template <size_t kCount>
  static HWY_INLINE LaneBits may_meet(const TriangleBlock&, const Edges&, int, float, const PacketRays& rays,
                                      const LaneHits&) {
    return first_lanes(kCount) << rays.first;
  }

  template <size_t kCount>
  static HWY_INLINE LaneBits meet(const TriangleBlock& block, const Edges&, int k, LaneBits lanes,
                                  const PacketRays& rays, const GivenRays&, LaneHits& lane) {
    constexpr float kEpsilon = 1e-4f;
    const LaneTag tag;
    const LaneIntTag int_tag;
    using V = hn::Vec<LaneTag>;
    const auto cross = [](V p, V q, V r, V s) HWY_ATTR { return hn::MulSub(p, q, hn::Mul(r, s)); };
    const auto dot = [](V px, V py, V pz, V qx, V qy, V qz)
                         HWY_ATTR { return hn::MulAdd(px, qx, hn::MulAdd(py, qy, hn::Mul(pz, qz))); };
    for (size_t step = 0; step < kCount; step += hn::MaxLanes(tag)) {
      const size_t i = rays.first + step;
      if (!(lanes >> i & first_lanes(hn::MaxLanes(tag)))) continue;
      const auto corner = [&](int vertex, int axis) HWY_ATTR { return hn::Set(tag, block.vertex[vertex][axis][k]); };
      const V dx = hn::Load(tag, rays.direction[0] + i), dy = hn::Load(tag, rays.direction[1] + i),
              dz = hn::Load(tag, rays.direction[2] + i);
      const V ax = corner(0, 0), ay = corner(0, 1), az = corner(0, 2);
      const V bx = hn::Sub(corner(1, 0), ax), by = hn::Sub(corner(1, 1), ay), bz = hn::Sub(corner(1, 2), az);
      const V cx = hn::Sub(corner(2, 0), ax), cy = hn::Sub(corner(2, 1), ay), cz = hn::Sub(corner(2, 2), az);
      const V px = cross(dy, cz, dz, cy), py = cross(dz, cx, dx, cz), pz = cross(dx, cy, dy, cx);
      const V inverse = hn::Div(hn::Set(tag, 1.0f), dot(bx, by, bz, px, py, pz));
      const V sx = hn::Sub(hn::Load(tag, rays.origin[0] + i), ax), sy = hn::Sub(hn::Load(tag, rays.origin[1] + i), ay),
              sz = hn::Sub(hn::Load(tag, rays.origin[2] + i), az);
      const V qx = cross(sy, bz, sz, by), qy = cross(sz, bx, sx, bz), qz = cross(sx, by, sy, bx);
      const V u = hn::Mul(dot(sx, sy, sz, px, py, pz), inverse), v = hn::Mul(dot(dx, dy, dz, qx, qy, qz), inverse),
              t = hn::Mul(dot(cx, cy, cz, qx, qy, qz), inverse);
      const V zero = hn::Zero(tag), high = hn::Load(tag, lane.high + i);
      auto met = hn::And(hn::And(hn::Ge(u, zero), hn::Ge(v, zero)), hn::Le(hn::Add(u, v), hn::Set(tag, 1.0f)));
      const V start = hn::Add(hn::Load(tag, lane.t_sure + i), hn::Set(tag, kEpsilon));
      met = hn::And(met, hn::And(hn::Gt(t, start), hn::Lt(t, high)));
      if (hn::AllFalse(tag, met)) continue;
      hn::Store(hn::IfThenElse(met, kAnyHit ? hn::Set(tag, -INFINITY) : t, high), tag, lane.high + i);
      const auto taken = hn::RebindMask(int_tag, met);
      hn::Store(hn::IfThenElse(taken, hn::Set(int_tag, block.body[k]), hn::Load(int_tag, lane.body + i)), int_tag,
                lane.body + i);
      hn::Store(hn::IfThenElse(taken, hn::Set(int_tag, block.prim[k]), hn::Load(int_tag, lane.prim + i)), int_tag,
                lane.prim + i);
    }
    return 0;
  }
};

void naive_closest_rays(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<Hit> hits) {
  trace_packets<PacketWalk<false, NaiveTriangles<false>>>(
      scene, rays, hits, [&](size_t i) HWY_ATTR { hits[i] = Walk<false>(scene, rays[i]).run(); });
}

void naive_any_rays(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<uint8_t> is_blocked) {
  trace_packets<PacketWalk<true, NaiveTriangles<true>>>(
      scene, rays, is_blocked, [&](size_t i) HWY_ATTR { is_blocked[i] = Walk<true>(scene, rays[i]).run().is_hit(); });
}

void count_undecided(const CompiledScene& scene, std::span<const BoundedRay> rays, int64_t& closest, int64_t& any) {
  std::vector<Hit> hits(rays.size());
  std::vector<uint8_t> is_blocked(rays.size());
  trace_packets<PacketWalk<false>>(scene, rays, std::span(hits), [&](size_t) { ++closest; });
  trace_packets<PacketWalk<true>>(scene, rays, std::span(is_blocked), [&](size_t) { ++any; });
}

}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tilelight {

HWY_EXPORT(naive_closest_rays);
HWY_EXPORT(naive_any_rays);
HWY_EXPORT(count_undecided);

void naive_closest(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<Hit> hits) {
  HWY_DYNAMIC_DISPATCH(naive_closest_rays)(scene, rays, hits);
}

void naive_any(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<uint8_t> is_blocked) {
  HWY_DYNAMIC_DISPATCH(naive_any_rays)(scene, rays, is_blocked);
}

Undecided undecided_of(const CompiledScene& scene, std::span<const BoundedRay> rays) {
  Undecided out;
  HWY_DYNAMIC_DISPATCH(count_undecided)(scene, rays, out.closest, out.any);
  return out;
}

}  // namespace tilelight
#endif
