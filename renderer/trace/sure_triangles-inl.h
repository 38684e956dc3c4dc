// SPDX-License-Identifier: Apache-2.0
// A triangle against the rays of a packet, in float: what is met beyond doubt, and what float cannot say. Included once
// for every instruction set.
#if defined(TILELIGHT_SURE_TRIANGLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TILELIGHT_SURE_TRIANGLES_INL_H
#undef TILELIGHT_SURE_TRIANGLES_INL_H
#else
#define TILELIGHT_SURE_TRIANGLES_INL_H
#endif

#include "renderer/trace/packet_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {

// What rays know of their hits; t counts from the moved origins.
struct LaneHits {
  alignas(64) float low[kPacketRays], high[kPacketRays];      // the best hit's t lies between
  alignas(64) float doubt[kPacketRays];                       // no other hit, and no doubtful one, lies before
  alignas(64) float t_sure[kPacketRays];                      // from here on a hit lies ahead without any doubt
  alignas(64) uint32_t body[kPacketRays], prim[kPacketRays];  // the best hit; kNone: none
};

// What a packet knows of a block's triangles before it asks them one by one; the axes are the packet's.
//
// In the plane across the ray, sheared along kz, vertex 0 lies at p and the others at p + e and p + f. In the point
// that the ray meets the vertices weigh e x f - f x p - p x e, f x p and p x e; together e x f.
//
// How far these may be off, in units of 2^-25, S being the steepest slope (or 1) and Z the greatest distance of a
// vertex from an origin along kz. p + e and p + f decide the first weight, and are off by (1 + S) misplacement, by S Z
// kOffByDistance, and by 4 |p| + 12 L + 2 l for the roundings that grow with p, e and f, where L is the longest
// component of e and f, and l the longer |x| + |y|. Let m be |p.x| + |p.y| + l. The weight is off by all that times 2
// m, and by 22 l m for the roundings of crosses and their differences, so 13 l in all; the other weights are off by
// less, and the sum by no more than twice that.
struct BlockEdges {
  static constexpr float kUnit = 1.1f * 0x1p-25f;
  alignas(32) float e[3][8], f[3][8];  // along kx, ky and kz
  alignas(32) float length[8];         // l
  alignas(32) float off[8];            // but for |p|

  BlockEdges(const TriangleBlock& block, const PacketRays& rays) {
    const FloatTag tag;
    const int axes[3] = {rays.kx, rays.ky, rays.kz};
    const auto number = [](float of) HWY_ATTR { return hn::Set(FloatTag(), of); };
    const auto middle_x = number(rays.slope_middle[0]), middle_y = number(rays.slope_middle[1]),
               spread = number(rays.slope_spread);
    for (size_t i = 0; i < 8; i += hn::MaxLanes(tag)) {
      const auto vertex = [&](int v, int k) HWY_ATTR { return hn::Load(tag, block.vertex[v][axes[k]] + i); };
      auto component = hn::Zero(tag), longer = hn::Zero(tag);
      for (int v = 1; v < 3; ++v) {
        auto& to = v == 1 ? e : f;
        BoxVec edge[3];
        for (int k = 0; k < 3; ++k) {
          edge[k] = hn::Sub(vertex(v, k), vertex(0, k));
          hn::Store(edge[k], tag, to[k] + i);
          component = hn::Max(component, hn::Abs(edge[k]));
        }
        const auto x = hn::NegMulAdd(middle_x, edge[2], edge[0]), y = hn::NegMulAdd(middle_y, edge[2], edge[1]);
        longer = hn::Max(longer, hn::MulAdd(spread, hn::Abs(edge[2]), hn::Add(hn::Abs(x), hn::Abs(y))));
      }
      const auto lowest = hn::Min(vertex(0, 2), hn::Min(vertex(1, 2), vertex(2, 2))),
                 highest = hn::Max(vertex(0, 2), hn::Max(vertex(1, 2), vertex(2, 2)));
      const auto along = hn::Max(hn::Sub(highest, number(rays.origin_low[rays.kz])),
                                 hn::Sub(number(rays.origin_high[rays.kz]), lowest));
      const float steepest = rays.steepest;
      auto units = hn::MulAdd(number(kOffByDistance * steepest), along, number((1.0f + steepest) * rays.misplaced));
      units = hn::MulAdd(number(12.0f), component, hn::MulAdd(number(13.0f), longer, units));
      hn::Store(longer, tag, length + i);
      hn::Store(hn::Mul(units, number(2.0f * kUnit)), tag, off + i);
    }
  }
};

// What the vertices of one triangle weigh for a register of lanes.
struct LaneWeights {
  using V = hn::Vec<LaneTag>;
  V u, v, w, sum;
  V bound;  // no weight is off by more
  V pz;

  HWY_INLINE LaneWeights(const TriangleBlock& block, const BlockEdges& edges, int k, const PacketRays& rays, size_t i) {
    const LaneTag tag;
    const auto from_ray = [&](int axis) HWY_ATTR {
      return hn::Sub(hn::Set(tag, block.vertex[0][axis][k]), hn::Load(tag, rays.origin[axis] + i));
    };
    const V sx = hn::Load(tag, rays.slope[0] + i), sy = hn::Load(tag, rays.slope[1] + i);
    const V ez = hn::Set(tag, edges.e[2][k]), fz = hn::Set(tag, edges.f[2][k]);
    pz = from_ray(rays.kz);
    const V px = hn::NegMulAdd(sx, pz, from_ray(rays.kx)), py = hn::NegMulAdd(sy, pz, from_ray(rays.ky));
    const V ex = hn::NegMulAdd(sx, ez, hn::Set(tag, edges.e[0][k])),
            ey = hn::NegMulAdd(sy, ez, hn::Set(tag, edges.e[1][k]));
    const V fx = hn::NegMulAdd(sx, fz, hn::Set(tag, edges.f[0][k])),
            fy = hn::NegMulAdd(sy, fz, hn::Set(tag, edges.f[1][k]));
    const auto cross = [](V ax, V ay, V bx, V by) HWY_ATTR { return hn::MulSub(ax, by, hn::Mul(ay, bx)); };
    v = cross(fx, fy, px, py), w = cross(px, py, ex, ey), sum = cross(ex, ey, fx, fy);
    u = hn::Sub(hn::Sub(sum, v), w);
    const V m = hn::Add(hn::Add(hn::Abs(px), hn::Abs(py)), hn::Set(tag, edges.length[k]));
    const V off = hn::MulAdd(hn::Set(tag, 8.0f * BlockEdges::kUnit), m, hn::Set(tag, edges.off[k]));
    bound = hn::MulAdd(off, m, hn::Set(tag, 0x1p-36f));  // and what is off in both factors
  }
  // Whether all weights are above `least`, or all below its opposite.
  HWY_INLINE auto agree_beyond(V least) const {
    return hn::Or(hn::Gt(hn::Min(u, hn::Min(v, w)), least), hn::Lt(hn::Max(u, hn::Max(v, w)), hn::Neg(least)));
  }
};

// One triangle of a block against all lanes, of which most mostly miss it: so it is asked first whether any may meet
// it.
template <bool kAnyHit>
struct SureTriangles {
  using Edges = BlockEdges;
  static constexpr bool kInDouble = true;  // what is found is computed in double at the end

  // Which lanes may meet the k-th triangle. entry: no lane does before this t.
  template <size_t kCount>
  static HWY_INLINE LaneBits may_meet(const TriangleBlock& block, const BlockEdges& edges, int k, float entry,
                                      const PacketRays& rays, const LaneHits& lane) {
    const LaneTag tag;
    LaneBits lanes = 0;
    for (size_t step = 0; step < kCount; step += hn::MaxLanes(tag)) {
      const size_t i = rays.first + step;
      const LaneWeights weights(block, edges, k, rays, i);
      const auto is_before_end = hn::Ge(hn::Load(tag, lane.high + i), hn::Set(tag, entry));
      lanes |= lane_bits(hn::And(weights.agree_beyond(hn::Neg(weights.bound)), is_before_end)) << i;
    }
    return lanes;
  }

  // Of the lanes that may meet it, hits beyond doubt go to low, high and prim; returned are those of which float cannot
  // say.
  template <size_t kCount>
  static HWY_INLINE LaneBits meet(const TriangleBlock& block, const BlockEdges& edges, int k, LaneBits lanes,
                                  const PacketRays& rays, const GivenRays& given, LaneHits& lane) {
    const LaneTag tag;
    const LaneIntTag int_tag;
    using V = hn::Vec<LaneTag>;
    const uint32_t body = block.body[k], prim = block.prim[k];
    if (given.has_left) lanes &= ~(lanes_equal(given.left_prim, prim) & lanes_equal(given.left_body, body));
    const auto take = [&](auto mask, size_t i) HWY_ATTR {
      const auto taken = hn::RebindMask(int_tag, mask);
      const auto put = [&](uint32_t what, uint32_t* row) HWY_ATTR {
        hn::Store(hn::IfThenElse(taken, hn::Set(int_tag, what), hn::Load(int_tag, row + i)), int_tag, row + i);
      };
      put(body, lane.body), put(prim, lane.prim);
    };
    LaneBits unsure = 0;
    for (size_t step = 0; step < kCount; step += hn::MaxLanes(tag)) {
      const size_t i = rays.first + step;
      const LaneBits here = lanes >> i & first_lanes(hn::MaxLanes(tag));
      if (here == 0) continue;
      const uint8_t bits[8] = {static_cast<uint8_t>(here), static_cast<uint8_t>(here >> 8)};
      auto maybe = hn::LoadMaskBits(tag, bits);
      const LaneWeights weights(block, edges, k, rays, i);
      const V high = hn::Load(tag, lane.high + i);
      auto surely = hn::And(maybe, weights.agree_beyond(hn::Mul(hn::Set(tag, 1.125f), weights.bound)));
      // A weight is off by less than its bound, and the sum, more than three bounds, by less than two: so a share of
      // the sum by less than (1 + 2 share) bound / sum, and t by no more than four times that of the edges' range.
      const V ez = hn::Set(tag, edges.e[2][k]), fz = hn::Set(tag, edges.f[2][k]);
      const V sz = hn::Load(tag, rays.inverse[rays.kz] + i);
      const V inverse = hn::Div(hn::Set(tag, 1.0f), weights.sum);
      const V at = hn::Mul(sz, hn::MulAdd(hn::MulAdd(weights.v, ez, hn::Mul(weights.w, fz)), inverse, weights.pz));
      const V range = hn::Mul(hn::Abs(sz), hn::Max(hn::Abs(ez), hn::Abs(fz)));
      const V size = hn::Add(hn::Add(hn::Abs(at), range), hn::Set(tag, 1.0f));
      const V slack = hn::MulAdd(hn::Set(tag, kFilterSlack), size, hn::Load(tag, rays.tie + i));
      const V off = hn::MulAdd(hn::Mul(hn::Set(tag, 4.0f), weights.bound), hn::Mul(range, hn::Abs(inverse)), slack);
      const V low = hn::Sub(at, off), upper = hn::Add(at, off);
      const auto is_elsewhere = hn::Or(hn::Lt(upper, hn::Load(tag, rays.t_min + i)), hn::Gt(low, high));
      maybe = hn::AndNot(hn::And(surely, is_elsewhere), maybe);
      surely = hn::And(hn::And(surely, maybe), hn::Gt(low, hn::Load(tag, lane.t_sure + i)));
      if (kAnyHit) surely = hn::And(surely, hn::Lt(upper, hn::Load(tag, lane.low + i)));
      unsure |= lane_bits(hn::AndNot(surely, maybe)) << i;
      if (kAnyHit) {
        hn::Store(hn::IfThenElse(surely, hn::Set(tag, -INFINITY), high), tag, lane.high + i);
        take(surely, i);
        continue;
      }
      const auto wins = hn::And(surely, hn::Lt(upper, high));
      const auto loses = hn::AndNot(wins, surely);
      const V best_low = hn::Load(tag, lane.low + i);
      V before = hn::IfThenElse(wins, best_low, hn::Set(tag, INFINITY));
      before = hn::IfThenElse(loses, low, before);
      hn::Store(hn::Min(hn::Load(tag, lane.doubt + i), before), tag, lane.doubt + i);
      hn::Store(hn::IfThenElse(wins, upper, high), tag, lane.high + i);
      hn::Store(hn::IfThenElse(wins, low, best_low), tag, lane.low + i);
      take(wins, i);
    }
    return unsure;
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#endif
