// SPDX-License-Identifier: Apache-2.0
// DoubleDouble: an unevaluated sum hi + lo of two doubles with |lo| <= ulp(hi)/2, about 106 bits. The error-free
// transformations of Dekker 1971 and Knuth (TAOCP 2, 4.2.2), without fused operations: every step is exactly rounded.
// Pure; any thread.
#pragma once

#include <bit>
#include <cstdint>

namespace tilelight {

struct DoubleDouble {
  double hi = 0.0, lo = 0.0;
};

// a + b exactly.
inline DoubleDouble two_sum(double a, double b) {
  const double s = a + b;
  const double b_part = s - a;
  return {s, (a - (s - b_part)) + (b - b_part)};
}

// a + b exactly. REQUIRES: |a| >= |b|, or a = 0.
inline DoubleDouble fast_two_sum(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}

// The upper 26 bits of a. By masking, not by Veltkamp's product, so that large values do not overflow.
inline double upper_half(double a) {
  return std::bit_cast<double>(std::bit_cast<uint64_t>(a) & 0xFFFF'FFFF'F800'0000ull);
}

// a * b exactly, unless it overflows or the low part underflows.
inline DoubleDouble two_product(double a, double b) {
  const double p = a * b;
  const double a_hi = upper_half(a), a_lo = a - a_hi;
  const double b_hi = upper_half(b), b_lo = b - b_hi;
  return {p, ((a_hi * b_hi - p) + a_hi * b_lo + a_lo * b_hi) + a_lo * b_lo};
}

inline DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble s = two_sum(a.hi, b.hi);
  return fast_two_sum(s.hi, s.lo + (a.lo + b.lo));
}

inline DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble p = two_product(a.hi, b.hi);
  return fast_two_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}

inline DoubleDouble operator/(DoubleDouble a, DoubleDouble b) {
  const double q = a.hi / b.hi;
  const DoubleDouble back = two_product(q, b.hi);
  return fast_two_sum(q, (((a.hi - back.hi) - back.lo) + (a.lo - q * b.lo)) / b.hi);
}

}  // namespace tilelight
