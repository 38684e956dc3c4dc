// SPDX-License-Identifier: Apache-2.0
// Sine, cosine, tangent and their inverses. The argument reductions and the polynomial coefficients are those of
// fdlibm 5.3 (Sun Microsystems 1993: k_sin.c, k_cos.c, e_rem_pio2.c, s_atan.c, e_acos.c); the code is our own.
#include <cmath>
#include <limits>

#include "renderer/base/double_double.h"
#include "renderer/base/elementary.h"

namespace tilelight::elementary {
namespace {

// pi/2 and pi as the nearest double and the rest.
constexpr DoubleDouble kHalfPi = {1.57079632679489655800e+00, 6.12323399573676603587e-17};
constexpr DoubleDouble kWholePi = {3.14159265358979311600e+00, 1.22464679914735317722e-16};

struct Reduced {
  DoubleDouble r;    // |r| <= pi/4, a little more at the ends
  unsigned quarter;  // the angle is quarter * pi/2 + r
};

// Cody and Waite: pi/2 in parts of 33 bits, whose products with a count of quarters below 2^20 are exact.
Reduced reduce(double rad) {
  constexpr double kPart1 = 1.57079632673412561417e+00, kPart2 = 6.07710050630396597660e-11,
                   kPart3 = 2.02226624871116645580e-21, kRest = 8.47842766036889956997e-32;
  constexpr double kTwoOverPi = 6.36619772367581382433e-01;
  // Beyond the stated domain the angle has few good bits left: folding it by the double 2 pi keeps the result a sine.
  if (std::fabs(rad) > 1.6e6) rad = std::fmod(rad, 4.0 * kHalfPi.hi);
  const double n = std::floor(rad * kTwoOverPi + 0.5);
  const DoubleDouble a = two_sum(rad - n * kPart1, -n * kPart2);
  const DoubleDouble b = two_sum(a.hi, -n * kPart3);
  return {fast_two_sum(b.hi, b.lo + (a.lo - n * kRest)), static_cast<unsigned>(static_cast<int64_t>(n)) & 3u};
}

// sin(r) for |r| <= pi/4, with what rounding took from it.
DoubleDouble sin_kernel(DoubleDouble r) {
  constexpr double kS1 = -1.66666666666666324348e-01, kS2 = 8.33333333332248946124e-03,
                   kS3 = -1.98412698298579493134e-04, kS4 = 2.75573137070700676789e-06,
                   kS5 = -2.50507602534068634195e-08, kS6 = 1.58969099521155010221e-10;
  const double x = r.hi, z = x * x, cube = z * x;
  const double tail = kS2 + z * (kS3 + z * (kS4 + z * (kS5 + z * kS6)));
  return fast_two_sum(x, -((z * (0.5 * r.lo - cube * tail) - r.lo) - cube * kS1));
}

// cos(r) for |r| <= pi/4, with what rounding took from it.
DoubleDouble cos_kernel(DoubleDouble r) {
  constexpr double kC1 = 4.16666666666666019037e-02, kC2 = -1.38888888888741095749e-03,
                   kC3 = 2.48015872894767294178e-05, kC4 = -2.75573143513906633035e-07,
                   kC5 = 2.08757232129817482790e-09, kC6 = -1.13596475577881948265e-11;
  const double x = r.hi, z = x * x;
  const double tail = z * z * (kC1 + z * (kC2 + z * (kC3 + z * (kC4 + z * (kC5 + z * kC6)))));
  const double half = 0.5 * z, w = 1.0 - half;
  return fast_two_sum(w, ((1.0 - w) - half) + (tail - x * r.lo));
}

bool is_finite(double x) { return std::fabs(x) <= std::numeric_limits<double>::max(); }
double nan() { return std::numeric_limits<double>::quiet_NaN(); }

// atan(x) for x >= 0, by the nearest of four angles whose tangent is known and the atan of the difference.
double atan_positive(double x) {
  constexpr double kT[] = {3.33333333333329318027e-01,  -1.99999999998764832476e-01, 1.42857142725034663711e-01,
                           -1.11111104054623557880e-01, 9.09088713343650656196e-02,  -7.69187620504482999495e-02,
                           6.66107313738753120669e-02,  -5.83357013379057348645e-02, 4.97687799461593236017e-02,
                           -3.65315727442169155270e-02, 1.62858201153657823623e-02};
  DoubleDouble angle = {0.0, 0.0};
  if (x >= 39.0 / 16.0) {
    angle = kHalfPi;
    x = -1.0 / x;
  } else if (x >= 19.0 / 16.0) {
    angle = {9.82793723247329054082e-01, 1.39033110312309984516e-17};  // atan 1.5
    x = (x - 1.5) / (1.0 + 1.5 * x);
  } else if (x >= 11.0 / 16.0) {
    angle = {7.85398163397448278999e-01, 3.06161699786838301793e-17};  // atan 1
    x = (x - 1.0) / (x + 1.0);
  } else if (x >= 7.0 / 16.0) {
    angle = {4.63647609000806093515e-01, 2.26987774529616870924e-17};  // atan 0.5
    x = (2.0 * x - 1.0) / (2.0 + x);
  }
  const double z = x * x;
  double series = 0.0;
  for (int i = 10; i >= 0; --i) series = kT[i] + z * series;
  return angle.hi - ((x * z * series - angle.lo) - x);
}

// (asin(x) - x) / x as a function of z = x*x <= 1/4.
double asin_tail(double z) {
  constexpr double kP0 = 1.66666666666666657415e-01, kP1 = -3.25565818622400915405e-01,
                   kP2 = 2.01212532134862925881e-01, kP3 = -4.00555345006794114027e-02,
                   kP4 = 7.91534994289814532176e-04, kP5 = 3.47933107596021167570e-05;
  constexpr double kQ1 = -2.40339491173441421878e+00, kQ2 = 2.02094576023350569471e+00,
                   kQ3 = -6.88283971605453293030e-01, kQ4 = 7.70381505559019352791e-02;
  const double p = z * (kP0 + z * (kP1 + z * (kP2 + z * (kP3 + z * (kP4 + z * kP5)))));
  const double q = 1.0 + z * (kQ1 + z * (kQ2 + z * (kQ3 + z * kQ4)));
  return p / q;
}

}  // namespace

double sin(double rad) {
  if (!is_finite(rad)) return nan();
  if (std::fabs(rad) < 0x1p-27) return rad;  // also keeps the sign of -0
  const Reduced a = reduce(rad);
  const double value = a.quarter & 1u ? cos_kernel(a.r).hi : sin_kernel(a.r).hi;
  return a.quarter & 2u ? -value : value;
}

double cos(double rad) {
  if (!is_finite(rad)) return nan();
  const Reduced a = reduce(rad);
  const double value = a.quarter & 1u ? sin_kernel(a.r).hi : cos_kernel(a.r).hi;
  return (a.quarter + 1u) & 2u ? -value : value;
}

double tan(double rad) {
  if (!is_finite(rad)) return nan();
  if (std::fabs(rad) < 0x1p-27) return rad;
  const Reduced a = reduce(rad);
  const DoubleDouble s = sin_kernel(a.r), c = cos_kernel(a.r);
  return a.quarter & 1u ? -(c / s).hi : (s / c).hi;
}

double acos(double x) {
  if (x != x) return x;
  if (x >= 1.0) return 0.0;
  if (x <= -1.0) return kWholePi.hi;
  if (std::fabs(x) < 0.5) return kHalfPi.hi - (x - (kHalfPi.lo - x * asin_tail(x * x)));
  // acos x = 2 asin sqrt((1 - x) / 2), and the same from the other end.
  const double z = 0.5 * (1.0 - std::fabs(x));
  const double s = std::sqrt(z);
  if (x < 0.0) return kWholePi.hi - 2.0 * (s + (asin_tail(z) * s - kHalfPi.lo));
  const double s_hi = upper_half(s);  // its square is exact, so the rest of the root is known well
  const double s_lo = (z - s_hi * s_hi) / (s + s_hi);
  return 2.0 * (s_hi + (asin_tail(z) * s + s_lo));
}

double atan2(double y, double x) {
  if (x != x || y != y) return nan();
  const double ay = std::fabs(y), ax = std::fabs(x);
  if (ay != 0.0 && (ax == 0.0 || (!is_finite(ay) && is_finite(ax)))) return std::signbit(y) ? -kHalfPi.hi : kHalfPi.hi;
  // Of the point reflected into the first quadrant; ax = ay also when both are infinite.
  double angle = ay == 0.0 ? 0.0 : ax == ay ? 0.5 * kHalfPi.hi : atan_positive(ay / ax);
  if (std::signbit(x)) angle = kWholePi.hi - (angle - kWholePi.lo);
  return std::signbit(y) ? -angle : angle;
}

}  // namespace tilelight::elementary
