// SPDX-License-Identifier: Apache-2.0
// The rays of a packet side by side in float, as the filter of packets sees them, and which boxes they meet: all
// together, by the intervals of their origins and directions, and then by lane. Included once for every instruction
// set.
#if defined(TILELIGHT_PACKET_RAYS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TILELIGHT_PACKET_RAYS_INL_H
#undef TILELIGHT_PACKET_RAYS_INL_H
#else
#define TILELIGHT_PACKET_RAYS_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <span>

#include "renderer/trace/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {

using LaneTag = hn::CappedTag<float, kPacketRays>;
using LaneIntTag = hn::RebindToUnsigned<LaneTag>;

// kCount lanes in one register's width, two by two through `merge`.
template <size_t kCount, class Merge>
HWY_INLINE hn::Vec<LaneTag> merged_lanes(const float* lanes, const Merge& merge) {
  const LaneTag tag;
  auto all = hn::Load(tag, lanes);
  for (size_t i = hn::MaxLanes(tag); i < kCount; i += hn::MaxLanes(tag)) all = merge(all, hn::Load(tag, lanes + i));
  return all;
}
template <size_t kCount>
HWY_INLINE float greatest_of(const float* lanes) {
  const auto all = merged_lanes<kCount>(lanes, [](auto a, auto b) HWY_ATTR { return hn::Max(a, b); });
  return hn::GetLane(hn::MaxOfLanes(LaneTag(), all));
}

// The rays as they were given, by column. Lanes beyond the last ray repeat the first, and end before they start.
struct GivenRays {
  alignas(64) double origin[3][kPacketRays], direction[3][kPacketRays], t_max[kPacketRays];
  alignas(64) double reach[kPacketRays];                                // as of Start
  alignas(64) uint32_t left_body[kPacketRays], left_prim[kPacketRays];  // what the ray has left
  bool has_left = false;
};

#if HWY_MAX_BYTES >= 64
// Eight rays from rays[first] on, through registers: what is written a number at a time is read late.
HWY_INLINE void read_eight(std::span<const BoundedRay> rays, size_t first, GivenRays& out) {
  static_assert(sizeof(BoundedRay) == 72 && offsetof(BoundedRay, t_max) == 64 && offsetof(Ray, left) == 48);
  const DoubleTag tag;
  const hn::Half<DoubleTag> half;
  const hn::Half<decltype(half)> quarter;
  const auto row = [&](size_t i) HWY_ATTR { return reinterpret_cast<const double*>(&rays[first + i]); };
  DoubleVec pair[2][4];  // even and odd columns of two rays side by side
  hn::Vec<decltype(quarter)> end[4];
  for (size_t k = 0; k < 4; ++k) {
    const DoubleVec a = hn::LoadU(tag, row(2 * k)), b = hn::LoadU(tag, row(2 * k + 1));
    pair[0][k] = hn::InterleaveLower(tag, a, b), pair[1][k] = hn::InterleaveUpper(tag, a, b);
    end[k] = hn::InterleaveUpper(quarter, hn::LoadU(quarter, row(2 * k) + 7), hn::LoadU(quarter, row(2 * k + 1) + 7));
  }
  DoubleVec column[8];
  for (size_t odd = 0; odd < 2; ++odd) {
    const auto& p = pair[odd];
    const auto even_of = [](DoubleVec a, DoubleVec b)
                             HWY_ATTR { return hn::OddEvenBlocks(hn::SwapAdjacentBlocks(b), a); };
    const auto odd_of = [](DoubleVec a, DoubleVec b)
                            HWY_ATTR { return hn::OddEvenBlocks(b, hn::SwapAdjacentBlocks(a)); };
    const DoubleVec a = even_of(p[0], p[1]), b = odd_of(p[0], p[1]), c = even_of(p[2], p[3]), d = odd_of(p[2], p[3]);
    column[odd] = hn::ConcatLowerLower(tag, c, a), column[2 + odd] = hn::ConcatLowerLower(tag, d, b);
    column[4 + odd] = hn::ConcatUpperUpper(tag, c, a), column[6 + odd] = hn::ConcatUpperUpper(tag, d, b);
  }
  for (size_t axis = 0; axis < 3; ++axis) {
    hn::Store(column[axis], tag, out.origin[axis] + first);
    hn::Store(column[3 + axis], tag, out.direction[axis] + first);
  }
  hn::Store(hn::Combine(tag, hn::Combine(half, end[3], end[2]), hn::Combine(half, end[1], end[0])), tag,
            out.t_max + first);
  const hn::RebindToUnsigned<DoubleTag> bits_tag;
  const hn::Rebind<uint32_t, DoubleTag> int_tag;
  const auto left = hn::BitCast(bits_tag, column[6]);
  const auto body = hn::TruncateTo(int_tag, left);
  hn::Store(body, int_tag, out.left_body + first);
  hn::Store(hn::TruncateTo(int_tag, hn::ShiftRight<32>(left)), int_tag, out.left_prim + first);
  out.has_left |= !hn::AllTrue(int_tag, hn::Eq(body, hn::Set(int_tag, kNone)));
}
#endif

HWY_INLINE void read_rays(std::span<const BoundedRay> rays, GivenRays& out) {
  out.has_left = false;
  size_t first = 0;
#if HWY_MAX_BYTES >= 64
  for (; first + 8 <= rays.size(); first += 8) read_eight(rays, first, out);
#endif
  for (size_t i = first; i < kPacketRays; ++i) {
    const BoundedRay& ray = rays[i < rays.size() ? i : 0];
    for (int axis = 0; axis < 3; ++axis) {
      out.origin[axis][i] = ray.ray.origin[axis];
      out.direction[axis][i] = ray.ray.direction[axis];
    }
    out.left_body[i] = ray.ray.left.body, out.left_prim[i] = ray.ray.left.prim;
    out.t_max[i] = i < rays.size() ? ray.t_max : kMissed;
    out.has_left |= ray.ray.left.body != kNone;
  }
  std::fill_n(out.reach, kPacketRays, 0.0);
  if (!out.has_left) return;
  for (size_t i = 0; i < kPacketRays; ++i) {
    const double size = std::abs(out.origin[0][i]) + std::abs(out.origin[1][i]) + std::abs(out.origin[2][i]);
    const double reach = reach_at(size);
    out.reach[i] = out.left_body[i] == kNone ? 0.0 : reach;
  }
}

// The rays in the world, as FilterRay has one; t counts from the moved origins.
struct PacketRays {
  alignas(64) float origin[3][kPacketRays], direction[3][kPacketRays], inverse[3][kPacketRays];
  alignas(64) float scaled[3][kPacketRays];                // a plane p is met at p * inverse - scaled
  alignas(64) float t_min[kPacketRays], tie[kPacketRays];  // tie: how far apart hits are that may be in one place
  alignas(64) float slope[2][kPacketRays];                 // of the sheared planes, along kx and ky
  alignas(64) double shift[kPacketRays];
  size_t first = 0;  // the lanes from here on walk together
  // Over these, by axis. is_mixed: some directions go up and some down.
  // slope: 1 / |direction|. The fourth numbers fill the registers.
  alignas(16) float origin_low[4], origin_high[4], slope_low[4], slope_high[4], direction_most[4];
  bool is_mixed[3];
  int near_side[3];  // where not mixed. 0: enters by the lower plane
  float t_least;
  int kx = 0, ky = 1, kz = 2;
  float slope_middle[2], slope_spread;  // how far the two slopes, together, are from these
  float steepest = 1.0f;                // no slope is more, nor 1
  float strayed = 0.0f;                 // by how many 2^-25 the lines may lie elsewhere, from far away
  float misplaced = 0.0f;               // by how many a vertex may be from an origin, before it is sheared
  bool is_near = true;                  // no origin is so far away that the boxes' width would not cover its rounding
};

// Of 1 / d, finite also for d = 0.
HWY_INLINE hn::Vec<LaneTag> inverse_of(hn::Vec<LaneTag> d) {
  const LaneTag tag;
  const auto tiny = hn::CopySign(hn::Set(tag, kTinySlope), d);
  return hn::Div(hn::Set(tag, 1.0f), hn::IfThenElse(hn::Lt(hn::Abs(d), hn::Abs(tiny)), tiny, d));
}
// Where t is rounded to a float.
HWY_INLINE hn::Vec<LaneTag> filter_slack(hn::Vec<LaneTag> t) {
  const LaneTag tag;
  return hn::Mul(hn::Set(tag, kFilterSlack), hn::Add(hn::Set(tag, 1.0f), hn::Abs(t)));
}

// Numbers of a register of lanes, given as double.
inline constexpr size_t kHalves = hn::MaxLanes(LaneTag()) / hn::MaxLanes(DoubleTag());
HWY_INLINE hn::Vec<LaneTag> narrowed(const DoubleVec (&wide)[kHalves]) {
#if HWY_TARGET == HWY_SCALAR
  return hn::DemoteTo(LaneTag(), wide[0]);
#else
  const hn::Rebind<float, DoubleTag> narrow;
  return hn::Combine(LaneTag(), hn::DemoteTo(narrow, wide[1]), hn::DemoteTo(narrow, wide[0]));
#endif
}

HWY_INLINE DoubleVec widened(hn::Vec<LaneTag> narrow, [[maybe_unused]] size_t half) {
#if HWY_TARGET == HWY_SCALAR
  return hn::PromoteTo(DoubleTag(), narrow);
#else
  const hn::Rebind<float, DoubleTag> of_half;
  return hn::PromoteTo(DoubleTag(), half == 0 ? hn::LowerHalf(of_half, narrow) : hn::UpperHalf(of_half, narrow));
#endif
}
// The quotients over / under of a register of lanes, rounded once. inverse: about 1 / under.
HWY_INLINE hn::Vec<LaneTag> slope_of(const double* over, const double* under, hn::Vec<LaneTag> inverse) {
  const DoubleTag wide;
  DoubleVec numerators[kHalves], rests[kHalves];
  for (size_t h = 0; h < kHalves; ++h) numerators[h] = hn::Load(wide, over + h * hn::MaxLanes(wide));
  const auto rough = hn::Mul(narrowed(numerators), inverse);
  for (size_t h = 0; h < kHalves; ++h)
    rests[h] = hn::NegMulAdd(widened(rough, h), hn::Load(wide, under + h * hn::MaxLanes(wide)), numerators[h]);
  return hn::MulAdd(narrowed(rests), inverse, rough);
}

// What each lane needs by itself. t_sure: from here on a hit lies ahead without any doubt; the ray's end lies between
// low and high.
HWY_INLINE void make_lanes(const GivenRays& given, PacketRays& out, float* t_sure, float* low, float* high) {
  constexpr double kFarthest = 0x1p16;
  const DoubleTag wide;
  const LaneTag tag;
  using V = hn::Vec<LaneTag>;
  auto farthest = hn::Zero(wide);
  for (size_t i = 0; i < kPacketRays; i += hn::MaxLanes(tag)) {
    DoubleVec origin[3][kHalves], direction[3][kHalves], shifts[kHalves], ends[kHalves], reaches[kHalves];
    for (size_t h = 0; h < kHalves; ++h) {
      const size_t k = i + h * hn::MaxLanes(wide);
      const auto x = hn::Load(wide, given.origin[0] + k), y = hn::Load(wide, given.origin[1] + k),
                 z = hn::Load(wide, given.origin[2] + k);
      const auto dx = hn::Load(wide, given.direction[0] + k), dy = hn::Load(wide, given.direction[1] + k),
                 dz = hn::Load(wide, given.direction[2] + k);
      const auto along = hn::MulAdd(x, dx, hn::MulAdd(y, dy, hn::Mul(z, dz)));
      const auto square = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
      const auto shift = hn::IfThenElseZero(hn::Gt(square, hn::Set(wide, kNearOrigin2)), hn::Neg(along));
      farthest = hn::Max(farthest, square);
      hn::Store(shift, wide, out.shift + k);
      origin[0][h] = hn::MulAdd(shift, dx, x), direction[0][h] = dx;
      origin[1][h] = hn::MulAdd(shift, dy, y), direction[1][h] = dy;
      origin[2][h] = hn::MulAdd(shift, dz, z), direction[2][h] = dz;
      shifts[h] = shift, reaches[h] = hn::Load(wide, given.reach + k);
      ends[h] = hn::Min(hn::Sub(hn::Load(wide, given.t_max + k), shift), hn::Set(wide, double{WideBvh::kNowhere}));
    }
    for (size_t axis = 0; axis < 3; ++axis) {
      const V d = narrowed(direction[axis]), o = narrowed(origin[axis]), inverse = inverse_of(d);
      hn::Store(o, tag, out.origin[axis] + i);
      hn::Store(d, tag, out.direction[axis] + i);
      hn::Store(inverse, tag, out.inverse[axis] + i);
      hn::Store(hn::Mul(o, inverse), tag, out.scaled[axis] + i);
    }
    const V shift = narrowed(shifts), reach = narrowed(reaches), end = narrowed(ends);
    const V start = hn::Neg(hn::Add(reach, shift));
    hn::Store(hn::Sub(start, filter_slack(start)), tag, out.t_min + i);
    const V tie = hn::Mul(hn::Set(tag, 0x1p-24f), hn::Add(hn::Set(tag, 1.0f), hn::Abs(shift)));
    hn::Store(hn::Add(tie, hn::Set(tag, 0x1p-21f)), tag, out.tie + i);
    const V sure = hn::Sub(hn::Add(reach, reach), shift);
    hn::Store(hn::Add(sure, filter_slack(sure)), tag, t_sure + i);
    // Infinite slack and minus infinity would make a NaN.
    const auto is_idle = hn::Lt(end, hn::Set(tag, -WideBvh::kNowhere));
    hn::Store(hn::IfThenElse(is_idle, end, hn::Add(end, filter_slack(end))), tag, high + i);
    hn::Store(hn::Sub(end, filter_slack(end)), tag, low + i);
  }
  const auto is_within = [&](double distance) HWY_ATTR {
    return hn::AllTrue(wide, hn::Lt(farthest, hn::Set(wide, distance * distance)));
  };
  out.is_near = is_within(kFarthest);
  out.strayed = is_within(0x1p11) ? 0x1p-4f : 2.0f;  // as `strayed` tells
}

template <class Mask>
HWY_INLINE LaneBits lane_bits(Mask mask) {
  uint8_t bits[8] = {};
  hn::StoreMaskBits(LaneTag(), mask, bits);
  if constexpr (hn::MaxLanes(LaneTag()) <= 8) return bits[0];
  if constexpr (std::endian::native == std::endian::little) {  // as one number, in a register
    uint16_t both;
    std::memcpy(&both, bits, sizeof both);
    return both;
  }
  return bits[0] | static_cast<LaneBits>(bits[1]) << 8;
}
// The lanes of a row that are `what`.
HWY_INLINE LaneBits lanes_equal(const uint32_t* row, uint32_t what) {
  const LaneTag tag;
  const LaneIntTag int_tag;
  LaneBits lanes = 0;
  for (size_t i = 0; i < kPacketRays; i += hn::MaxLanes(tag)) {
    const auto is_equal = hn::Eq(hn::Load(int_tag, row + i), hn::Set(int_tag, what));
    lanes |= lane_bits(hn::RebindMask(tag, is_equal)) << i;
  }
  return lanes;
}

// By how many 2^-25 a sheared vertex is off for each unit of its distance along kz and of the steepest slope (at least
// 1): by 2 for the rounding of the slope, which may be a little above 1, by 4 for those of the two differences and,
// where it is rounded by itself, by 2 for that of the product.
inline constexpr bool kIsFused = HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3;  // MulAdd and the like
inline constexpr float kOffByDistance = kIsFused ? 6.0f : 8.0f;
// The roundings of a vertex (find_merged sees to it that none is outside [-1, 1]) and of an origin with components up
// to this, in 2^-25.
HWY_INLINE float misplacement(float component, float strayed) { return 1.0f + 2.0f * component + strayed; }

using FourTag = hn::CappedTag<float, 4>;
// Of each of four rows of lanes, through `merge`, into out[0..3]: four at once take half the steps of one by one.
template <size_t kCount, class Merge>
HWY_INLINE void merge_four(const float* a, const float* b, const float* c, const float* d, const Merge& merge,
                           float* out) {
#if HWY_TARGET == HWY_SCALAR
  const float* rows[4] = {a, b, c, d};
  for (size_t k = 0; k < 4; ++k) hn::Store(merged_lanes<kCount>(rows[k], merge), FourTag(), out + k);
#else
  const LaneTag tag;
  const hn::RepartitionToWide<LaneIntTag> pairs;
  const auto two = [&](const float* p, const float* q) HWY_ATTR {
    const auto v = merged_lanes<kCount>(p, merge), w = merged_lanes<kCount>(q, merge);
    return hn::BitCast(pairs, merge(hn::InterleaveLower(tag, v, w), hn::InterleaveUpper(tag, v, w)));
  };
  const auto v = two(a, b), w = two(c, d);
  const auto four = merge(hn::BitCast(tag, hn::InterleaveLower(pairs, v, w)),
                          hn::BitCast(tag, hn::InterleaveUpper(pairs, v, w)));  // in every block of 128 bits
  if constexpr (hn::MaxLanes(tag) == 16) {
    const hn::Half<LaneTag> half;
    const auto eight = merge(hn::LowerHalf(half, four), hn::UpperHalf(half, four));
    hn::Store(merge(hn::LowerHalf(FourTag(), eight), hn::UpperHalf(FourTag(), eight)), FourTag(), out);
  } else if constexpr (hn::MaxLanes(tag) == 8) {
    hn::Store(merge(hn::LowerHalf(FourTag(), four), hn::UpperHalf(FourTag(), four)), FourTag(), out);
  } else {
    hn::Store(four, tag, out);
  }
#endif
}

// What bounds kCount lanes. False: they go too many ways to be walked together.
template <size_t kCount>
HWY_INLINE bool bound_lanes(size_t first, const GivenRays& given, PacketRays& out) {
  out.first = first;
  const LaneTag tag;
  const FourTag four;
  const auto lesser = [](auto a, auto b) HWY_ATTR { return hn::Min(a, b); };
  const auto greater = [](auto a, auto b) HWY_ATTR { return hn::Max(a, b); };
  const auto& d = out.direction;
  alignas(16) float d_low[4], d_high[4], weak[4];
  merge_four<kCount>(d[0] + first, d[1] + first, d[2] + first, d[2] + first, lesser, d_low);
  merge_four<kCount>(d[0] + first, d[1] + first, d[2] + first, d[2] + first, greater, d_high);
  const float wx = d_high[0] - d_low[0], wy = d_high[1] - d_low[1], wz = d_high[2] - d_low[2];
  constexpr float kWidest = 0.45f;  // about 25 degrees
  if (!(wx * wx + wy * wy + wz * wz < kWidest * kWidest)) return false;
  merge_four<kCount>(out.origin[0] + first, out.origin[1] + first, out.origin[2] + first, out.t_min + first, lesser,
                     out.origin_low);
  merge_four<kCount>(out.origin[0] + first, out.origin[1] + first, out.origin[2] + first, out.origin[2] + first,
                     greater, out.origin_high);
  out.t_least = out.origin_low[3];
  for (size_t i = 0; i < 4; i += hn::MaxLanes(four)) {
    const auto low = hn::Load(four, d_low + i), high = hn::Load(four, d_high + i), tiny = hn::Set(four, kTinySlope);
    const auto one_way = hn::Or(hn::Gt(low, tiny), hn::Lt(high, hn::Neg(tiny)));
    const auto weakest = hn::IfThenElseZero(one_way, hn::Min(hn::Abs(low), hn::Abs(high)));
    const auto most = hn::Max(hn::Abs(low), hn::Abs(high)), one = hn::Set(four, 1.0f);
    hn::Store(weakest, four, weak + i);
    hn::Store(most, four, out.direction_most + i);
    // Quotients are rounded alike here and by lane.
    hn::Store(hn::Div(one, most), four, out.slope_low + i);
    hn::Store(hn::Div(one, weakest), four, out.slope_high + i);
  }
  for (int axis = 0; axis < 3; ++axis) {
    out.is_mixed[axis] = weak[axis] == 0.0f;
    out.near_side[axis] = d_high[axis] < 0.0f;
  }
  out.kz = weak[0] >= weak[1] && weak[0] >= weak[2] ? 0 : weak[1] >= weak[2] ? 1 : 2;
  const float most = weak[out.kz];
  if (!(most >= 0.5f)) return false;
  out.kx = out.kz == 2 ? 0 : out.kz + 1, out.ky = out.kz == 0 ? 2 : out.kz - 1;
  for (size_t i = first; i < first + kCount; i += hn::MaxLanes(tag)) {
    const auto inverse = hn::Load(tag, out.inverse[out.kz] + i);
    hn::Store(slope_of(given.direction[out.kx] + i, given.direction[out.kz] + i, inverse), tag, out.slope[0] + i);
    hn::Store(slope_of(given.direction[out.ky] + i, given.direction[out.kz] + i, inverse), tag, out.slope[1] + i);
  }
  const float middle_z = d_low[out.kz] + d_high[out.kz];
  out.slope_middle[0] = (d_low[out.kx] + d_high[out.kx]) / middle_z;
  out.slope_middle[1] = (d_low[out.ky] + d_high[out.ky]) / middle_z;
  const float width[3] = {wx, wy, wz};
  const float turned = (std::abs(out.slope_middle[0]) + std::abs(out.slope_middle[1])) * width[out.kz];
  out.slope_spread = (width[out.kx] + width[out.ky] + turned) * 0.5001f / most;
  float farthest = 0.0f;
  for (int axis = 0; axis < 3; ++axis)
    farthest = std::max(farthest, std::max(-out.origin_low[axis], out.origin_high[axis]));
  out.misplaced = misplacement(farthest, out.strayed);
  out.steepest = std::max(1.0f, std::max(out.direction_most[out.kx], out.direction_most[out.ky]) / most);
  return true;
}

using BoxVec = hn::Vec<FloatTag>;

// Which of eight boxes some ray may meet between t_least and t_most, as bits; entry: not before which t.
// plane(side, axis, i): the boxes' lower or upper planes from the i-th box on.
template <class Plane>
HWY_INLINE uint32_t boxes_met(const PacketRays& rays, const Plane& plane, float t_most, float* entry) {
  const FloatTag tag;
  uint32_t mask = 0;
  for (size_t i = 0; i < WideBvh::kWidth; i += hn::MaxLanes(tag)) {
    BoxVec near = hn::Set(tag, rays.t_least), far = hn::Set(tag, t_most);
    for (int axis = 0; axis < 3; ++axis) {
      if (rays.is_mixed[axis]) continue;
      const int side = rays.near_side[axis];
      const BoxVec low = hn::Set(tag, rays.origin_low[axis]), high = hn::Set(tag, rays.origin_high[axis]);
      const BoxVec slow = hn::Set(tag, rays.slope_low[axis]), fast = hn::Set(tag, rays.slope_high[axis]);
      // How far the planes are along the axis, the way the rays go.
      const BoxVec first = plane(side, axis, i), last = plane(1 - side, axis, i);
      const BoxVec to_first = side ? hn::Sub(low, first) : hn::Sub(first, high);
      const BoxVec to_last = side ? hn::Sub(high, last) : hn::Sub(last, low);
      near = hn::Max(near, hn::Min(hn::Mul(to_first, slow), hn::Mul(to_first, fast)));
      far = hn::Min(far, hn::Max(hn::Mul(to_last, slow), hn::Mul(to_last, fast)));
    }
    auto met = hn::Le(near, far);
    // Where rays go both ways along an axis, by how far they get along it.
    const BoxVec most = hn::Max(hn::Abs(near), hn::Abs(far));
    for (int axis = 0; axis < 3; ++axis) {
      if (!rays.is_mixed[axis]) continue;
      const BoxVec reach = hn::Mul(most, hn::Set(tag, rays.direction_most[axis]));
      met = hn::And(met, hn::Le(hn::Sub(plane(0, axis, i), reach), hn::Set(tag, rays.origin_high[axis])));
      met = hn::And(met, hn::Ge(hn::Add(plane(1, axis, i), reach), hn::Set(tag, rays.origin_low[axis])));
    }
    hn::Store(near, tag, entry + i);
    uint8_t bits[8] = {};
    hn::StoreMaskBits(tag, met, bits);
    mask |= static_cast<uint32_t>(bits[0]) << i;
  }
  return mask;
}

// Of kCount lanes those that meet the c-th box of a node. That an origin is scaled before it is subtracted is a
// rounding of the origin, which the boxes' width covers.
template <size_t kCount>
HWY_INLINE LaneBits lanes_met(const PacketRays& rays, const WideBvh::Node& node, int c, const float* t_max) {
  const LaneTag tag;
  LaneBits lanes = 0;
  for (size_t k = 0; k < kCount; k += hn::MaxLanes(tag)) {
    const size_t i = rays.first + k;
    auto near = hn::Load(tag, rays.t_min + i), far = hn::Load(tag, t_max + i);
    for (int axis = 0; axis < 3; ++axis) {
      const auto scaled = hn::Load(tag, rays.scaled[axis] + i), inverse = hn::Load(tag, rays.inverse[axis] + i);
      const int side = rays.is_mixed[axis] ? 0 : rays.near_side[axis];
      auto a = hn::MulSub(hn::Set(tag, node.bounds[side][axis][c]), inverse, scaled);
      auto b = hn::MulSub(hn::Set(tag, node.bounds[1 - side][axis][c]), inverse, scaled);
      if (rays.is_mixed[axis]) {
        const auto lesser = hn::Min(a, b);
        b = hn::Max(a, b), a = lesser;
      }
      near = hn::Max(near, a);
      far = hn::Min(far, b);
    }
    lanes |= lane_bits(hn::Le(near, far)) << i;
  }
  return lanes;
}

}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#endif
