// SPDX-License-Identifier: Apache-2.0
// The numbers in which light is computed: one double, or Lanes, several doubles side by side. What is written for a
// number R is written once and gives the same bits for both: every operation here is exactly rounded by IEEE 754 and
// none is fused. Included once for every instruction set.
#if defined(TILELIGHT_REALS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TILELIGHT_REALS_INL_H
#undef TILELIGHT_REALS_INL_H
#else
#define TILELIGHT_REALS_INL_H
#endif

#include <hwy/highway.h>

#include <cmath>
#include <cstdint>

#include "renderer/base/vec.h"

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using RealTag = hn::CappedTag<double, 8>;
inline constexpr size_t kLanes = hn::MaxLanes(RealTag());

struct LaneMask {
  hn::Mask<RealTag> m;
};
HWY_INLINE LaneMask operator&(LaneMask a, LaneMask b) { return {hn::And(a.m, b.m)}; }
HWY_INLINE LaneMask operator|(LaneMask a, LaneMask b) { return {hn::Or(a.m, b.m)}; }
HWY_INLINE LaneMask operator!(LaneMask a) { return {hn::Not(a.m)}; }
HWY_INLINE bool any(LaneMask a) { return !hn::AllFalse(RealTag(), a.m); }
HWY_INLINE uint32_t bits_of(LaneMask a) {
  uint8_t bits[8] = {};
  hn::StoreMaskBits(RealTag(), a.m, bits);
  return bits[0];
}
HWY_INLINE LaneMask mask_of(uint32_t bits) {
  const uint8_t bytes[8] = {static_cast<uint8_t>(bits)};
  return {hn::LoadMaskBits(RealTag(), bytes)};
}
HWY_INLINE bool any(bool a) { return a; }

struct Lanes {
  hn::Vec<RealTag> v;
  Lanes() = default;
  HWY_INLINE Lanes(double x) : v(hn::Set(RealTag(), x)) {}  // implicit: a number is the same in every lane
  HWY_INLINE explicit Lanes(hn::Vec<RealTag> x) : v(x) {}
};
HWY_INLINE Lanes operator+(Lanes a, Lanes b) { return Lanes(hn::Add(a.v, b.v)); }
HWY_INLINE Lanes operator-(Lanes a, Lanes b) { return Lanes(hn::Sub(a.v, b.v)); }
HWY_INLINE Lanes operator*(Lanes a, Lanes b) { return Lanes(hn::Mul(a.v, b.v)); }
HWY_INLINE Lanes operator/(Lanes a, Lanes b) { return Lanes(hn::Div(a.v, b.v)); }
HWY_INLINE Lanes operator-(Lanes a) { return Lanes(hn::Neg(a.v)); }
HWY_INLINE LaneMask operator<(Lanes a, Lanes b) { return {hn::Lt(a.v, b.v)}; }
HWY_INLINE LaneMask operator>(Lanes a, Lanes b) { return {hn::Gt(a.v, b.v)}; }
HWY_INLINE LaneMask operator<=(Lanes a, Lanes b) { return {hn::Le(a.v, b.v)}; }
HWY_INLINE LaneMask operator>=(Lanes a, Lanes b) { return {hn::Ge(a.v, b.v)}; }
HWY_INLINE LaneMask operator==(Lanes a, Lanes b) { return {hn::Eq(a.v, b.v)}; }

HWY_INLINE Lanes root(Lanes a) { return Lanes(hn::Sqrt(a.v)); }
HWY_INLINE Lanes floored(Lanes a) { return Lanes(hn::Floor(a.v)); }
HWY_INLINE Lanes magnitude(Lanes a) { return Lanes(hn::Abs(a.v)); }
HWY_INLINE Lanes greater(Lanes a, Lanes b) { return Lanes(hn::IfThenElse(hn::Lt(a.v, b.v), b.v, a.v)); }
HWY_INLINE Lanes select(LaneMask m, Lanes a, Lanes b) { return Lanes(hn::IfThenElse(m.m, a.v, b.v)); }
HWY_INLINE Lanes load(const double* from) { return Lanes(hn::LoadU(RealTag(), from)); }
HWY_INLINE void store(Lanes a, double* to) { hn::StoreU(a.v, RealTag(), to); }

HWY_INLINE double root(double a) { return std::sqrt(a); }
HWY_INLINE double floored(double a) { return std::floor(a); }
HWY_INLINE double magnitude(double a) { return std::abs(a); }
HWY_INLINE double greater(double a, double b) { return a < b ? b : a; }
HWY_INLINE double select(bool m, double a, double b) { return m ? a : b; }
HWY_INLINE bool select(bool m, bool a, bool b) { return m ? a : b; }
HWY_INLINE LaneMask select(LaneMask m, LaneMask a, LaneMask b) { return (m & a) | ((!m) & b); }

template <class R>
using MaskOf = decltype(R() < R());

// A vector of three; also a colour.
template <class R>
struct Of3 {
  R x, y, z;
};
template <class R>
HWY_INLINE Of3<R> of(const Vec3& v) {
  return {R(v.x), R(v.y), R(v.z)};
}
HWY_INLINE Vec3 vec_of(const Of3<double>& v) { return {v.x, v.y, v.z}; }
template <class R>
HWY_INLINE Of3<R> operator+(const Of3<R>& a, const Of3<R>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class R>
HWY_INLINE Of3<R> operator-(const Of3<R>& a, const Of3<R>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class R>
HWY_INLINE Of3<R> operator*(const Of3<R>& a, const Of3<R>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class R>
HWY_INLINE Of3<R> operator*(R s, const Of3<R>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class R>
HWY_INLINE Of3<R> operator-(const Of3<R>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class R>
HWY_INLINE Of3<R> select(MaskOf<R> m, const Of3<R>& a, const Of3<R>& b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}
template <class R>
HWY_INLINE R dot(const Of3<R>& a, const Of3<R>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class R>
HWY_INLINE Of3<R> cross(const Of3<R>& a, const Of3<R>& b) {
  return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}
template <class R>
HWY_INLINE R length(const Of3<R>& a) {
  return root(dot(a, a));
}
template <class R>
HWY_INLINE Of3<R> normalized(const Of3<R>& a) {
  return (R(1.0) / root(dot(a, a))) * a;
}
template <class R>
HWY_INLINE Of3<R> transform_vector(const Mat3& m, const Of3<R>& v) {
  const auto row = [&](int i) HWY_ATTR { return R(m[0][i]) * v.x + R(m[1][i]) * v.y + R(m[2][i]) * v.z; };
  return {row(0), row(1), row(2)};
}
template <class R>
HWY_INLINE Of3<R> transform_point(const Mat4& m, const Of3<R>& p) {
  const auto row = [&](int i)
                       HWY_ATTR { return (R(m[0][i]) * p.x + R(m[1][i]) * p.y) + (R(m[2][i]) * p.z + R(m[3][i])); };
  return {row(0), row(1), row(2)};
}

// Numbers on their way between rows and lanes.
struct Gathered {
  alignas(64) double at[kLanes];
  HWY_INLINE Lanes lanes() const { return load(at); }
};
struct Gathered3 {
  Gathered axis[3];
  Gathered3() = default;
  HWY_INLINE explicit Gathered3(const Of3<Lanes>& v) {
    store(v.x, axis[0].at), store(v.y, axis[1].at), store(v.z, axis[2].at);
  }
  HWY_INLINE void set(size_t lane, const Vec3& v) {
    axis[0].at[lane] = v.x, axis[1].at[lane] = v.y, axis[2].at[lane] = v.z;
  }
  Vec3 lane(size_t i) const { return {axis[0].at[i], axis[1].at[i], axis[2].at[i]}; }
  HWY_INLINE Of3<Lanes> lanes() const { return {axis[0].lanes(), axis[1].lanes(), axis[2].lanes()}; }
};

// What has no form in lanes, computed one by one where `which` says so: out = f(in...), of doubles or of vectors.
template <class F>
HWY_INLINE void each_lane(LaneMask which, Lanes& out, const F& f, Lanes a, Lanes b) {
  Gathered x{}, y{}, result{};
  store(a, x.at), store(b, y.at), store(out, result.at);
  for (uint32_t bits = bits_of(which), i = 0; bits != 0; bits >>= 1, ++i) {
    if (bits & 1) result.at[i] = f(x.at[i], y.at[i]);
  }
  out = result.lanes();
}
template <class F>
HWY_INLINE void each_lane(bool which, double& out, const F& f, double a, double b) {
  if (which) out = f(a, b);
}
template <class F, class... In>
HWY_INLINE void each_lane(LaneMask which, Of3<Lanes>& out, const F& f, const In&... in) {
  Gathered3 result(out);
  const uint32_t chosen = bits_of(which);
  const auto compute = [&](const auto&... stored) {
    for (uint32_t bits = chosen, i = 0; bits != 0; bits >>= 1, ++i) {
      if (bits & 1) result.set(i, f(stored.lane(i)...));
    }
  };
  compute(Gathered3(in)...);
  out = result.lanes();
}
template <class F, class... In>
HWY_INLINE void each_lane(bool which, Of3<double>& out, const F& f, const In&... in) {
  if (!which) return;
  const Vec3 v = f(vec_of(in)...);
  out = {v.x, v.y, v.z};
}

}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#endif
