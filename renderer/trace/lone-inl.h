// SPDX-License-Identifier: Apache-2.0
// One lane of a packet by itself: a ray whose neighbours go elsewhere. It asks eight boxes or eight triangles at once,
// by the same filter and with the same margins as a packet; its set-up and its final hit are the packet's, all
// lanes side by side. Included once for every instruction set.
#if defined(TILELIGHT_LONE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TILELIGHT_LONE_INL_H
#undef TILELIGHT_LONE_INL_H
#else
#define TILELIGHT_LONE_INL_H
#endif

#include "renderer/trace/sure_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {

// What is left for a lane to visit, and where it enters it.
struct LoneEntry {
  uint32_t node;
  float t;
};

// A lane's numbers, together.
struct LoneRay {
  float inverse[3], scaled[3];  // a plane p is met at p * inverse - scaled
  int near_at[3], far_at[3];    // where a node's near and far planes lie, among its bounds
  int kx, ky, kz;               // kz: of the longest component, so that no slope exceeds 1
  float ox, oy, oz, sx, sy, sz;
  float t_min, tie, misplaced;
  LoneEntry* stack;  // the nearest are at the top
  int top;

  void set(const PacketRays& rays, const GivenRays& given, size_t lane, LoneEntry* room) {
    t_min = rays.t_min[lane], tie = rays.tie[lane];
    const float d[3] = {rays.direction[0][lane], rays.direction[1][lane], rays.direction[2][lane]};
    for (int axis = 0; axis < 3; ++axis) {
      inverse[axis] = rays.inverse[axis][lane];
      scaled[axis] = rays.scaled[axis][lane];
      constexpr int kWidth = WideBvh::kWidth;
      const int lower = axis * kWidth, upper = (3 + axis) * kWidth;
      near_at[axis] = inverse[axis] < 0.0f ? upper : lower, far_at[axis] = inverse[axis] < 0.0f ? lower : upper;
    }
    const float x = std::abs(d[0]), y = std::abs(d[1]), z = std::abs(d[2]);
    const bool is_z = z > std::max(x, y), is_y = !is_z & (y > x);  // no branches: neighbours differ
    kz = 2 * is_z + is_y;
    kx = kz == 2 ? 0 : kz + 1, ky = kz == 0 ? 2 : kz - 1;
    ox = rays.origin[kx][lane], oy = rays.origin[ky][lane], oz = rays.origin[kz][lane];
    const double over = 1.0 / given.direction[kz][lane];
    misplaced = misplacement(std::max({std::abs(ox), std::abs(oy), std::abs(oz)}), rays.strayed);
    sz = inverse[kz];
    sx = static_cast<float>(given.direction[kx][lane] * over),
    sy = static_cast<float>(given.direction[ky][lane] * over);
    stack = room, top = 0;
  }
  void push(uint32_t what, float at) { stack[top++] = {what, at}; }
};

// Where nodes and blocks lie.
struct TreePlaces {
  uintptr_t start[2], size[2];  // of nodes, of blocks
  explicit TreePlaces(const TriangleTree& tree)
      : start{reinterpret_cast<uintptr_t>(tree.nodes.data()), reinterpret_cast<uintptr_t>(tree.blocks.data())},
        size{sizeof(WideBvh::Node), sizeof(TriangleBlock)} {}
};
// What a lane visits next, a node or a block; which of them is hard to predict. A body's number leads nowhere.
HWY_INLINE void prefetch_any(const TreePlaces& places, uint32_t reference) {
  const uint32_t is_leaf = reference >> 31;
  // A whole number, for it may point nowhere.
  const uintptr_t place = places.start[is_leaf] + uintptr_t{reference & ~WideBvh::kLeafBit} * places.size[is_leaf];
  for (uintptr_t line = 0; line < sizeof(TriangleBlock); line += 64)
    hwy::Prefetch(reinterpret_cast<const char*>(place + line));
}

#if HWY_MAX_BYTES >= 32
// Eight numbers in descending order (a bitonic network).
HWY_INLINE hn::Vec<hn::RebindToUnsigned<FloatTag>> sorted_down(hn::Vec<hn::RebindToUnsigned<FloatTag>> v) {
  const hn::RebindToUnsigned<FloatTag> tag;
  using V = decltype(v);
  const auto order = [&](V there, uint32_t lesser) HWY_ATTR {
    alignas(32) uint32_t bits[8];
    for (uint32_t i = 0; i < 8; ++i) bits[i] = lesser >> i & 1 ? ~0u : 0;
    const auto mask = hn::MaskFromVec(hn::Load(tag, bits));
    v = hn::IfThenElse(mask, hn::Min(v, there), hn::Max(v, there));
  };
  order(hn::Shuffle2301(v), 0b10101010);
  order(hn::Shuffle0123(v), 0b11001100);
  order(hn::Shuffle2301(v), 0b10101010);
  order(hn::Reverse(tag, v), 0b11110000);
  order(hn::Shuffle1032(v), 0b11001100);
  order(hn::Shuffle2301(v), 0b10101010);
  return v;
}
#endif

// Pushes those of a node's children whose boxes the ray may meet before t_max, the nearest last if they are to be
// sorted.
template <bool kSorted>
HWY_INLINE void push_children(const WideBvh::Node& node, float t_max, LoneRay& ray) {
  const FloatTag tag;
  constexpr size_t kLanes = hn::MaxLanes(tag);
  const float* bounds = &node.bounds[0][0][0];
  HWY_ALIGN float entry[WideBvh::kWidth];
  uint32_t mask = 0;
  for (size_t i = 0; i < WideBvh::kWidth; i += kLanes) {
    const auto planes = [&](int axis, int place) HWY_ATTR {
      return hn::MulSub(hn::Load(tag, bounds + place + i), hn::Set(tag, ray.inverse[axis]),
                        hn::Set(tag, ray.scaled[axis]));
    };
    const auto near = hn::Max(hn::Max(planes(0, ray.near_at[0]), planes(1, ray.near_at[1])),
                              hn::Max(planes(2, ray.near_at[2]), hn::Set(tag, ray.t_min)));
    const auto far = hn::Min(hn::Min(planes(0, ray.far_at[0]), planes(1, ray.far_at[1])),
                             hn::Min(planes(2, ray.far_at[2]), hn::Set(tag, t_max)));
    const auto is_met = hn::Le(near, far);
#if HWY_MAX_BYTES >= 32
    // No branches: how many boxes a ray meets is hard to predict. The order is that of the distances' bits, of which
    // the last three make room for the place.
    const hn::RebindToUnsigned<FloatTag> int_tag;
    const auto places = hn::Iota(int_tag, 0), seven = hn::Set(int_tag, 7);
    auto order = places;
    if constexpr (kSorted) {
      const auto distance = hn::BitCast(int_tag, hn::Sub(near, hn::Set(tag, ray.t_min)));
      const auto key = hn::Or(hn::AndNot(seven, distance), places);
      order = hn::And(sorted_down(hn::IfThenElseZero(hn::RebindMask(int_tag, is_met), key)), seven);
    } else {
      order = hn::Compress(places, hn::RebindMask(int_tag, is_met));
    }
    const auto nodes = hn::TableLookupLanes(hn::Load(int_tag, node.child), hn::IndicesFromVec(int_tag, order));
    const auto at = hn::TableLookupLanes(hn::BitCast(int_tag, near), hn::IndicesFromVec(int_tag, order));
    hn::StoreInterleaved2(nodes, at, int_tag, &ray.stack[ray.top].node);
    ray.top += static_cast<int>(hn::CountTrue(tag, is_met));
#else
    hn::Store(near, tag, entry + i);
    uint8_t bits[8] = {};
    hn::StoreMaskBits(tag, is_met, bits);
    mask |= static_cast<uint32_t>(bits[0]) << i;
#endif
  }
  for (const int first = ray.top; mask != 0; mask &= mask - 1) {
    const int c = hwy::Num0BitsBelowLS1Bit_Nonzero32(mask);
    int place = ray.top++;
    for (; place > first && ray.stack[place - 1].t < entry[c]; --place) ray.stack[place] = ray.stack[place - 1];
    ray.stack[place] = {node.child[c], entry[c]};
  }
}

// What float can say of the triangles of a block, see SureTriangles.
struct LoneSift {
  uint32_t surely, unsure;
  alignas(32) float low[8], high[8];  // of those that are surely met: t lies between
};
template <bool kAnyHit>
HWY_INLINE void sift_block(const TriangleBlock& block, const LoneRay& ray, float t_sure, float t_low, float t_max,
                           LoneSift& out) {
  out.surely = out.unsure = 0;
  const FloatTag tag;
  using V = BoxVec;
  const V ox = hn::Set(tag, ray.ox), oy = hn::Set(tag, ray.oy), oz = hn::Set(tag, ray.oz);
  const V sx = hn::Set(tag, ray.sx), sy = hn::Set(tag, ray.sy), sz = hn::Set(tag, ray.sz);
  for (size_t i = 0; i < 8; i += hn::MaxLanes(tag)) {
    V x[3], y[3], t[3], most = hn::Zero(tag), along = hn::Zero(tag);
    for (int v = 0; v < 3; ++v) {
      const V z = hn::Sub(hn::Load(tag, block.vertex[v][ray.kz] + i), oz);
      x[v] = hn::NegMulAdd(sx, z, hn::Sub(hn::Load(tag, block.vertex[v][ray.kx] + i), ox));
      y[v] = hn::NegMulAdd(sy, z, hn::Sub(hn::Load(tag, block.vertex[v][ray.ky] + i), oy));
      t[v] = hn::Mul(sz, z);
      most = hn::Max(most, hn::Add(hn::Abs(x[v]), hn::Abs(y[v])));
      along = hn::Max(along, hn::Abs(z));
    }
    const V u = hn::MulSub(x[2], y[1], hn::Mul(y[2], x[1])), v = hn::MulSub(x[0], y[2], hn::Mul(y[0], x[2])),
            w = hn::MulSub(x[1], y[0], hn::Mul(y[1], x[0]));
    // As of BlockEdges, but that each vertex is rounded by itself: a weight is off by 2 most times the roundings of
    // vertex and origin, of slope, differences and product by distance, and 6 most for those of results and crosses.
    const V units = hn::MulAdd(hn::Set(tag, kOffByDistance), along,
                               hn::MulAdd(hn::Set(tag, 6.0f), most, hn::Set(tag, 2.0f * ray.misplaced)));
    const V bound = hn::MulAdd(hn::Mul(units, hn::Set(tag, 2.0f * BlockEdges::kUnit)), most, hn::Set(tag, 0x1p-36f));
    const V least = hn::Min(u, hn::Min(v, w)), greatest = hn::Max(u, hn::Max(v, w));
    const V nearest = hn::Min(t[0], hn::Min(t[1], t[2])), farthest = hn::Max(t[0], hn::Max(t[1], t[2]));
    const V size = hn::Max(hn::Abs(nearest), hn::Abs(farthest));
    const V slack = hn::MulAdd(hn::Set(tag, kFilterSlack), hn::Add(size, hn::Set(tag, 1.0f)), hn::Set(tag, ray.tie));
    const V high = hn::Set(tag, t_max);
    auto maybe = hn::Or(hn::Ge(least, hn::Neg(bound)), hn::Le(greatest, bound));
    maybe = hn::And(maybe, hn::And(hn::Le(hn::Sub(nearest, slack), high), hn::Ge(farthest, hn::Set(tag, ray.t_min))));
    const V more = hn::Mul(bound, hn::Set(tag, 1.125f));
    auto surely = hn::And(maybe, hn::Or(hn::Gt(least, more), hn::Lt(greatest, hn::Neg(more))));
    // Each weight is off by less than its bound, and their sum by three.
    const V inverse = hn::Div(hn::Set(tag, 1.0f), hn::Add(u, hn::Add(v, w)));
    const V at = hn::Mul(hn::MulAdd(u, t[0], hn::MulAdd(v, t[1], hn::Mul(w, t[2]))), inverse);
    const V off =
        hn::MulAdd(hn::Mul(hn::Set(tag, 6.0f), bound), hn::Mul(hn::Sub(farthest, nearest), hn::Abs(inverse)), slack);
    const V low = hn::Sub(at, off), upper = hn::Add(at, off);
    surely = hn::And(surely, hn::Gt(low, hn::Set(tag, t_sure)));
    if (kAnyHit) surely = hn::And(surely, hn::Lt(upper, hn::Set(tag, t_low)));
    uint8_t bits[8] = {};
    hn::StoreMaskBits(tag, surely, bits);
    out.surely |= static_cast<uint32_t>(bits[0]) << i;
    hn::StoreMaskBits(tag, hn::AndNot(surely, maybe), bits);
    out.unsure |= static_cast<uint32_t>(bits[0]) << i;
    if (kAnyHit) continue;
    hn::Store(low, tag, out.low + i);
    hn::Store(upper, tag, out.high + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#endif
