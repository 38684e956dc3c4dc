// SPDX-License-Identifier: Apache-2.0
// The rays of a packet side by side in double: their places in a body's space and where their lines meet triangles,
// spheres, boxes and planes, by the expressions of intersect.h to the last bit. Included once for every instruction
// set.
#if defined(TILELIGHT_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TILELIGHT_LANES_INL_H
#undef TILELIGHT_LANES_INL_H
#else
#define TILELIGHT_LANES_INL_H
#endif

#include <type_traits>

#include "renderer/trace/walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {

inline constexpr int kPacketRays = 32;

// A set of lanes, as bits.
using LaneBits = std::conditional_t<(kPacketRays > 32), uint64_t, uint32_t>;
HWY_INLINE constexpr LaneBits bit_of(size_t lane) { return LaneBits{1} << lane; }
HWY_INLINE constexpr LaneBits first_lanes(size_t count) {
  return count == 8 * sizeof(LaneBits) ? ~LaneBits{0} : bit_of(count) - 1;
}
HWY_INLINE size_t lowest_of(LaneBits lanes) {
  if constexpr (sizeof(LaneBits) == 8) return hwy::Num0BitsBelowLS1Bit_Nonzero64(lanes);
  return hwy::Num0BitsBelowLS1Bit_Nonzero32(static_cast<uint32_t>(lanes));
}

using DoubleTag = hn::CappedTag<double, 8>;
using DoubleVec = hn::Vec<DoubleTag>;

// The rays in a body's space: the numbers of to_local and moved_origin to the last bit.
struct LocalLanes {
  alignas(64) double origin[3][kPacketRays], direction[3][kPacketRays];
  alignas(64) double moved[3][kPacketRays], shift[kPacketRays];
};
HWY_INLINE void move_origins(LocalLanes& lanes) {
  const DoubleTag tag;
  const auto near = hn::Set(tag, kNearOrigin2);
  for (size_t i = 0; i < kPacketRays; i += hn::MaxLanes(tag)) {
    DoubleVec o[3], d[3];
    for (int axis = 0; axis < 3; ++axis)
      o[axis] = hn::Load(tag, lanes.origin[axis] + i), d[axis] = hn::Load(tag, lanes.direction[axis] + i);
    const auto dot = [](const DoubleVec(&a)[3], const DoubleVec(&b)[3]) HWY_ATTR {
      return hn::Add(hn::Add(hn::Mul(a[0], b[0]), hn::Mul(a[1], b[1])), hn::Mul(a[2], b[2]));
    };
    const auto square = dot(d, d);
    auto shift = hn::IfThenElseZero(hn::Gt(dot(o, o), near), hn::Div(hn::Neg(dot(o, d)), square));
    DoubleVec moved[3];
    for (int axis = 0; axis < 3; ++axis) moved[axis] = hn::Add(o[axis], hn::Mul(shift, d[axis]));
    const auto is_far = hn::Gt(dot(moved, moved), near);
    if (!hn::AllFalse(tag, is_far)) {
      const auto rest = hn::IfThenElseZero(is_far, hn::Div(hn::Neg(dot(moved, d)), square));
      shift = hn::Add(shift, rest);
      for (int axis = 0; axis < 3; ++axis) moved[axis] = hn::Add(moved[axis], hn::Mul(rest, d[axis]));
    }
    for (int axis = 0; axis < 3; ++axis) hn::Store(moved[axis], tag, lanes.moved[axis] + i);
    hn::Store(shift, tag, lanes.shift + i);
  }
}
HWY_INLINE void transform_lanes(const Mat4& m, const double (&origin)[3][kPacketRays],
                                const double (&direction)[3][kPacketRays], LocalLanes& out) {
  const DoubleTag tag;
  for (size_t i = 0; i < kPacketRays; i += hn::MaxLanes(tag)) {
    const auto ox = hn::Load(tag, origin[0] + i), oy = hn::Load(tag, origin[1] + i), oz = hn::Load(tag, origin[2] + i);
    const auto dx = hn::Load(tag, direction[0] + i), dy = hn::Load(tag, direction[1] + i),
               dz = hn::Load(tag, direction[2] + i);
    for (int axis = 0; axis < 3; ++axis) {
      const auto x = hn::Set(tag, m[0][axis]), y = hn::Set(tag, m[1][axis]), z = hn::Set(tag, m[2][axis]),
                 w = hn::Set(tag, m[3][axis]);
      const auto place = hn::Add(hn::Add(hn::Mul(x, ox), hn::Mul(y, oy)), hn::Add(hn::Mul(z, oz), w));
      hn::Store(place, tag, out.origin[axis] + i);
      hn::Store(hn::Add(hn::Add(hn::Mul(x, dx), hn::Mul(y, dy)), hn::Mul(z, dz)), tag, out.direction[axis] + i);
    }
  }
}

// What intersect_triangle gives, by lane.
struct ExactHits {
  alignas(64) double t[kPacketRays], b0[kPacketRays], b1[kPacketRays];
};

// The rays in the space of a mesh, sheared for the exact test of triangles: intersect_triangle to the last bit.
struct MeshLanes {
  uint32_t body = kNone;
  bool is_mixed = false;        // not all lanes have the same longest axis
  int kx = 0, ky = 1, kz = 2;   // the axes of all lanes; of mixed ones, those of space
  LaneBits by_x = 0, by_y = 0;  // lanes whose longest axis is this
  LocalLanes local;
  alignas(64) double moved[3][kPacketRays];  // along each lane's kx, ky and kz
  alignas(64) double sx[kPacketRays], sy[kPacketRays], sz[kPacketRays];

  int axis(int k) const { return k == 0 ? kx : k == 1 ? ky : kz; }

  void set(uint32_t index, const CompiledBody& of, const double (&origin)[3][kPacketRays],
           const double (&direction)[3][kPacketRays]) {
    body = index;
    transform_lanes(of.local_from_world, origin, direction, local);
    move_origins(local);
    const auto& d = local.direction;
    const DoubleTag tag;
    by_x = by_y = 0;
    for (size_t i = 0; i < kPacketRays; i += hn::MaxLanes(tag)) {
      const auto load = [&](const double(&of_axis)[kPacketRays]) HWY_ATTR { return hn::Load(tag, of_axis + i); };
      const auto x = load(d[0]), y = load(d[1]), z = load(d[2]);
      const auto ax = hn::Abs(x), ay = hn::Abs(y), az = hn::Abs(z);
      const auto is_x = hn::And(hn::Ge(ax, ay), hn::Ge(ax, az)), is_y = hn::AndNot(is_x, hn::Ge(ay, az));
      uint8_t bits[8] = {};
      hn::StoreMaskBits(tag, is_x, bits);
      by_x |= static_cast<LaneBits>(bits[0]) << i;
      hn::StoreMaskBits(tag, is_y, bits);
      by_y |= static_cast<LaneBits>(bits[0]) << i;
      DoubleVec along[3] = {x, y, z}, place[3] = {load(local.moved[0]), load(local.moved[1]), load(local.moved[2])};
      turn(is_x, is_y, along), turn(is_x, is_y, place);
      for (int k = 0; k < 3; ++k) hn::Store(place[k], tag, moved[k] + i);
      const auto inverse = hn::Div(hn::Set(tag, 1.0), along[2]);
      hn::Store(inverse, tag, sz + i);
      hn::Store(hn::Mul(along[0], inverse), tag, sx + i);
      hn::Store(hn::Mul(along[1], inverse), tag, sy + i);
    }
    constexpr LaneBits kAll = first_lanes(kPacketRays);
    is_mixed = by_x != kAll && by_y != kAll && (by_x | by_y) != 0;
    kz = is_mixed ? 2 : by_x == kAll ? 0 : by_y == kAll ? 1 : 2;
    kx = (kz + 1) % 3, ky = (kz + 2) % 3;
  }

  // From x, y, z to each lane's kx, ky, kz.
  template <class Mask>
  static HWY_INLINE void turn(Mask is_x, Mask is_y, DoubleVec (&p)[3]) {
    const DoubleVec x = p[0], y = p[1], z = p[2];
    p[0] = hn::IfThenElse(is_x, y, hn::IfThenElse(is_y, z, x));
    p[1] = hn::IfThenElse(is_x, z, hn::IfThenElse(is_y, x, y));
    p[2] = hn::IfThenElse(is_x, x, hn::IfThenElse(is_y, y, z));
  }

  // The lanes of a register from i on that meet their triangles; vertex(v, k): of these, along axis(k).
  template <class Vertex>
  HWY_INLINE LaneBits meet_some(size_t i, const Vertex& vertex, ExactHits& out) const {
    const DoubleTag tag;
    using V = DoubleVec;
    const V ox = hn::Load(tag, moved[0] + i), oy = hn::Load(tag, moved[1] + i), oz = hn::Load(tag, moved[2] + i);
    const V slope_x = hn::Load(tag, sx + i), slope_y = hn::Load(tag, sy + i);
    V p[3][3], x[3], y[3], z[3];
    for (int v = 0; v < 3; ++v)
      for (int k = 0; k < 3; ++k) p[v][k] = vertex(v, k);
    if (is_mixed) {
      const uint8_t x_bits[8] = {static_cast<uint8_t>(by_x >> i)}, y_bits[8] = {static_cast<uint8_t>(by_y >> i)};
      const auto is_x = hn::LoadMaskBits(tag, x_bits), is_y = hn::LoadMaskBits(tag, y_bits);
      for (auto& corner : p) turn(is_x, is_y, corner);
    }
    for (int v = 0; v < 3; ++v) {
      z[v] = hn::Sub(p[v][2], oz);
      x[v] = hn::Sub(hn::Sub(p[v][0], ox), hn::Mul(slope_x, z[v]));
      y[v] = hn::Sub(hn::Sub(p[v][1], oy), hn::Mul(slope_y, z[v]));
    }
    const V u = hn::Sub(hn::Mul(x[2], y[1]), hn::Mul(y[2], x[1])),
            v = hn::Sub(hn::Mul(x[0], y[2]), hn::Mul(y[0], x[2])),
            w = hn::Sub(hn::Mul(x[1], y[0]), hn::Mul(y[1], x[0]));
    const V zero = hn::Zero(tag), det = hn::Add(hn::Add(u, v), w);
    const auto is_out = hn::And(hn::Lt(hn::Min(u, hn::Min(v, w)), zero), hn::Gt(hn::Max(u, hn::Max(v, w)), zero));
    uint8_t bits[8] = {};
    hn::StoreMaskBits(tag, hn::AndNot(hn::Or(is_out, hn::Eq(det, zero)), hn::Eq(det, det)), bits);
    const V scale = hn::Div(hn::Set(tag, 1.0), det);
    const V along = hn::Add(hn::Add(hn::Mul(u, z[0]), hn::Mul(v, z[1])), hn::Mul(w, z[2]));
    const V t = hn::Mul(hn::Mul(along, hn::Load(tag, sz + i)), scale);
    hn::Store(hn::Add(hn::Load(tag, local.shift + i), t), tag, out.t + i);
    hn::Store(hn::Mul(u, scale), tag, out.b0 + i);
    hn::Store(hn::Mul(v, scale), tag, out.b1 + i);
    return static_cast<LaneBits>(bits[0]) << i;
  }

  // Which of these lanes meet a triangle.
  LaneBits meet(LaneBits lanes, const Vec3 (&triangle)[3], ExactHits& out) const {
    constexpr size_t kStep = hn::MaxLanes(DoubleTag());
    const auto vertex = [&](int v, int k) HWY_ATTR { return hn::Set(DoubleTag(), triangle[v][axis(k)]); };
    LaneBits met = 0;
    for (size_t i = 0; i < kPacketRays; i += kStep) {
      if (lanes >> i & first_lanes(kStep)) met |= meet_some(i, vertex, out);
    }
    return met & lanes;
  }
};

// Where the rays' lines enter and leave a solid, by the expressions of intersect.h; a line that misses it has both at
// minus infinity, and NaN stands for what is to be asked ray by ray.
struct LaneSpans {
  alignas(64) double near[kPacketRays], far[kPacketRays];
  alignas(64) uint32_t near_prim[kPacketRays] = {}, far_prim[kPacketRays] = {};
};
inline constexpr double kMissed = -std::numeric_limits<double>::infinity();
inline constexpr double kAskRay = std::numeric_limits<double>::quiet_NaN();

HWY_INLINE void sphere_spans(const LocalLanes& lanes, LaneSpans& out) {
  for (int i = 0; i < kPacketRays; ++i) {
    const double ox = lanes.origin[0][i], oy = lanes.origin[1][i], oz = lanes.origin[2][i];
    const double dx = lanes.direction[0][i], dy = lanes.direction[1][i], dz = lanes.direction[2][i];
    const double a = dx * dx + dy * dy + dz * dz, b = -(ox * dx + oy * dy + oz * dz), move = b / a;
    const double nx = ox + move * dx, ny = oy + move * dy, nz = oz + move * dz;
    const double discriminant = 1.0 - (nx * nx + ny * ny + nz * nz);
    const double q = b + std::copysign(std::sqrt(a * std::max(discriminant, 0.0)), b);
    const double r0 = (ox * ox + oy * oy + oz * oz - 1.0) / q, r1 = q / a;
    const bool is_met = discriminant >= 0.0;
    out.near[i] = is_met ? (r0 < r1 ? r0 : r1) : kMissed;
    out.far[i] = is_met ? (r0 < r1 ? r1 : r0) : kMissed;
  }
}

HWY_INLINE void plane_spans(const LocalLanes& lanes, LaneSpans& out) {
  for (int i = 0; i < kPacketRays; ++i) {
    const double d = lanes.direction[1][i], t = -lanes.origin[1][i] / d;
    out.near[i] = out.far[i] = d == 0.0 ? kMissed : t;
  }
}

HWY_INLINE void box_spans(const Vec3& half, const LocalLanes& lanes, LaneSpans& out) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kPacketRays; ++i) out.near[i] = -kInfinite, out.far[i] = kInfinite;
  for (int axis = 0; axis < 3; ++axis) {
    const double h = half[axis];
    const auto base = static_cast<uint32_t>(2 * axis);
    for (int i = 0; i < kPacketRays; ++i) {
      const double o = lanes.origin[axis][i], d = lanes.direction[axis][i];
      const bool is_upward = d > 0.0, is_level = d == 0.0, is_between = std::abs(o) <= h;
      const double near_side = is_upward ? -h : h;
      const double enter = is_level ? (is_between ? -kInfinite : kInfinite) : (near_side - o) / d;
      const double leave = is_level ? (is_between ? kInfinite : -kInfinite) : (-near_side - o) / d;
      const bool is_later = enter > out.near[i], is_sooner = leave < out.far[i];
      out.near[i] = is_later ? enter : out.near[i];
      out.near_prim[i] = is_later ? base + (is_upward ? 0 : 1) : out.near_prim[i];
      out.far[i] = is_sooner ? leave : out.far[i];
      out.far_prim[i] = is_sooner ? base + (is_upward ? 1 : 0) : out.far_prim[i];
    }
  }
  for (int i = 0; i < kPacketRays; ++i) {  // what misses the exact box may still be within rounding of it
    out.near[i] = out.near[i] <= out.far[i] ? out.near[i] : kAskRay;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#endif
