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

// One triangle of a block against all lanes: hits beyond doubt go to low, high and prim; returned are the lanes, as
// bits, of which float cannot say whether they meet it.
template <bool kAnyHit>
struct SureTriangles {
  static constexpr bool kInDouble = true;  // what is found is computed in double at the end

  template <size_t kCount>
  static HWY_INLINE LaneBits visit(const TriangleBlock& block, int k, LaneBits lanes, const PacketRays& rays,
                                   const GivenRays& given, LaneHits& lane) {
    const LaneTag tag;
    const LaneIntTag int_tag;
    using V = hn::Vec<LaneTag>;
    const auto body = hn::Set(int_tag, block.body[k]), prim = hn::Set(int_tag, block.prim[k]);
    const auto take = [&](auto mask, size_t i) HWY_ATTR {
      const auto taken = hn::RebindMask(int_tag, mask);
      hn::Store(hn::IfThenElse(taken, body, hn::Load(int_tag, lane.body + i)), int_tag, lane.body + i);
      hn::Store(hn::IfThenElse(taken, prim, hn::Load(int_tag, lane.prim + i)), int_tag, lane.prim + i);
    };
    LaneBits unsure = 0;
    for (size_t step = 0; step < kCount; step += hn::MaxLanes(tag)) {
      const size_t i = rays.first + step;
      if (!(lanes >> i & first_lanes(hn::MaxLanes(tag)))) continue;
      const V ox = hn::Load(tag, rays.origin[rays.kx] + i), oy = hn::Load(tag, rays.origin[rays.ky] + i),
              oz = hn::Load(tag, rays.origin[rays.kz] + i);
      const V sz = hn::Load(tag, rays.inverse[rays.kz] + i);
      const V sx = hn::Load(tag, rays.slope[0] + i), sy = hn::Load(tag, rays.slope[1] + i);
      V x[3], y[3], t[3], most = hn::Zero(tag);
      for (int v = 0; v < 3; ++v) {
        const V z = hn::Sub(hn::Set(tag, block.vertex[v][rays.kz][k]), oz);
        x[v] = hn::NegMulAdd(sx, z, hn::Sub(hn::Set(tag, block.vertex[v][rays.kx][k]), ox));
        y[v] = hn::NegMulAdd(sy, z, hn::Sub(hn::Set(tag, block.vertex[v][rays.ky][k]), oy));
        t[v] = hn::Mul(sz, z);
        most = hn::Max(most, hn::Add(hn::Abs(x[v]), hn::Abs(y[v])));
      }
      const V u = hn::MulSub(x[2], y[1], hn::Mul(y[2], x[1])), v = hn::MulSub(x[0], y[2], hn::Mul(y[0], x[2])),
              w = hn::MulSub(x[1], y[0], hn::Mul(y[1], x[0]));
      const V bound = hn::Mul(hn::Set(tag, 2.0f * rays.slack), most);
      const V least = hn::Min(u, hn::Min(v, w)), greatest = hn::Max(u, hn::Max(v, w));
      // The hit's t lies between those of the vertices.
      const V nearest = hn::Min(t[0], hn::Min(t[1], t[2])), farthest = hn::Max(t[0], hn::Max(t[1], t[2]));
      const V size = hn::Max(hn::Abs(nearest), hn::Abs(farthest));
      const V slack =
          hn::MulAdd(hn::Set(tag, kFilterSlack), hn::Add(size, hn::Set(tag, 1.0f)), hn::Load(tag, rays.tie + i));
      const V high = hn::Load(tag, lane.high + i);
      auto maybe = hn::Or(hn::Ge(least, hn::Neg(bound)), hn::Le(greatest, bound));
      maybe = hn::And(maybe,
                      hn::And(hn::Le(hn::Sub(nearest, slack), high), hn::Ge(farthest, hn::Load(tag, rays.t_min + i))));
      if (given.has_left) {
        const auto is_left = hn::And(hn::Eq(hn::Load(int_tag, given.left_prim + i), prim),
                                     hn::Eq(hn::Load(int_tag, given.left_body + i), body));
        maybe = hn::AndNot(hn::RebindMask(tag, is_left), maybe);
      }
      if (hn::AllFalse(tag, maybe)) continue;

      const V twice = hn::Add(bound, bound);
      auto surely = hn::And(maybe, hn::Or(hn::Gt(least, twice), hn::Lt(greatest, hn::Neg(twice))));
      if (hn::AllFalse(tag, surely)) {
        unsure |= lane_bits(maybe) << i;
        continue;
      }
      // Each weight is off by less than its bound, and their sum is at least six bounds.
      const V sum = hn::Add(u, hn::Add(v, w));
      const V inverse = hn::Div(hn::Set(tag, 1.0f), sum);
      const V at = hn::Mul(hn::MulAdd(u, t[0], hn::MulAdd(v, t[1], hn::Mul(w, t[2]))), inverse);
      const V off =
          hn::MulAdd(hn::Mul(hn::Set(tag, 6.0f), bound), hn::Mul(hn::Sub(farthest, nearest), hn::Abs(inverse)), slack);
      const V low = hn::Sub(at, off), upper = hn::Add(at, off);
      surely = hn::And(surely, hn::Gt(low, hn::Load(tag, lane.t_sure + i)));
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
