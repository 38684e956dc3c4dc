// SPDX-License-Identifier: Apache-2.0
// Exponentials, logarithms and powers. The argument reductions and the polynomial coefficients are those of fdlibm 5.3
// (Sun Microsystems 1993: e_exp.c, s_expm1.c, e_log.c, e_pow.c); the code is our own.
#include "renderer/base/elementary.h"

#include <bit>
#include <cmath>
#include <limits>

#include "renderer/base/double_double.h"

namespace tilelight::elementary {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInvLn2 = 1.44269504088896338700e+00;
// ln 2 with 33 bits in the upper part: its products with exponents are exact.
constexpr double kLn2Hi = 6.93147180369123816490e-01, kLn2Lo = 1.90821492927058770002e-10;
constexpr DoubleDouble kLn2 = {6.93147180559945286227e-01, 2.31904681384629955842e-17};

// 2^k. REQUIRES: -1022 <= k <= 1023.
double power_of_two(int k) { return std::bit_cast<double>(static_cast<uint64_t>(k + 1023) << 52); }

// x * 2^k, rounded once. REQUIRES: -1100 <= k <= 1025 and |x| in [1/4, 4].
double scale(double x, int k) {
  if (k > 1000) return x * power_of_two(k - 1000) * power_of_two(1000);
  if (k < -1000) return x * power_of_two(k + 1000) * power_of_two(-1000);
  return x * power_of_two(k);
}

struct Split {
  double m;  // significand in [1, 2)
  int k;     // x = m * 2^k
};

// REQUIRES: x positive and finite.
Split split(double x) {
  int k = 0;
  if (x < std::numeric_limits<double>::min()) {
    x *= 0x1p54;
    k = -54;
  }
  const uint64_t bits = std::bit_cast<uint64_t>(x);
  k += static_cast<int>(bits >> 52) - 1023;
  return {std::bit_cast<double>((bits & 0x000F'FFFF'FFFF'FFFFull) | 0x3FF0'0000'0000'0000ull), k};
}

// The same with m in [sqrt(1/2), sqrt(2)), so that log m loses nothing against k log 2.
Split split_about_one(double x) {
  Split s = split(x);
  if (s.m >= 1.41421356237309504880) {
    s.m *= 0.5;
    ++s.k;
  }
  return s;
}

// exp(r) for |r| <= 0.35.
double exp_kernel(DoubleDouble r) {
  constexpr double kP1 = 1.66666666666666019037e-01, kP2 = -2.77777777770155933842e-03,
                   kP3 = 6.61375632143793436117e-05, kP4 = -1.65339022054652515390e-06,
                   kP5 = 4.13813679705723846039e-08;
  const double x = r.hi + r.lo, z = x * x;
  const double c = x - z * (kP1 + z * (kP2 + z * (kP3 + z * (kP4 + z * kP5))));
  return 1.0 + ((x * c / (2.0 - c) + r.lo) + r.hi);
}

// 2^(a.hi + a.lo). REQUIRES: |a| <= 1100.
double exp2_kernel(DoubleDouble a) {
  const double k = std::floor(a.hi + 0.5);
  const DoubleDouble r = DoubleDouble{a.hi - k, a.lo} * kLn2;
  return scale(exp_kernel(r), static_cast<int>(k));
}

// What log(1 + f) has beyond f - f*f/2, for 1 + f in [sqrt(1/2), sqrt(2)): log(1+f) = f - (f*f/2 - log_tail(f)).
double log_tail(double f) {
  constexpr double kL1 = 6.666666666666735130e-01, kL2 = 3.999999999940941908e-01, kL3 = 2.857142874366239149e-01,
                   kL4 = 2.222219843214978396e-01, kL5 = 1.818357216161805012e-01, kL6 = 1.531383769920937332e-01,
                   kL7 = 1.479819860511658591e-01;
  const double s = f / (2.0 + f), z = s * s;
  const double series = z * (kL1 + z * (kL2 + z * (kL3 + z * (kL4 + z * (kL5 + z * (kL6 + z * kL7))))));
  return s * (0.5 * f * f + series);
}

// log(1 + f) + k log 2 + small.
double log_sum(double f, int k, double small) {
  const double n = k;
  return n * kLn2Hi - ((0.5 * f * f - (log_tail(f) + (n * kLn2Lo + small))) - f);
}

// log2(x) to about 68 bits: a power of y up to 2^10 leaves an exponent good to more than a double.
// log2(c (1+s)/(1-s)) = log2 c + (2 / (3 ln 2)) s (3 + s^2 + s^4 (3/5 + ...)), c the nearer of 1 and 3/2.
DoubleDouble log2_wide(double x) {
  constexpr double kL1 = 5.99999999999994648725e-01, kL2 = 4.28571428578550184252e-01, kL3 = 3.33333329818377432918e-01,
                   kL4 = 2.72728123808534006489e-01, kL5 = 2.30660745775561754067e-01, kL6 = 2.06975017800338417784e-01;
  constexpr DoubleDouble kTwoThirdsInvLn2 = {9.61796693925975554329e-01, 5.05776166481259067548e-17};
  constexpr DoubleDouble kLog2OfThreeHalves = {5.84962500721156186678e-01, -5.22449006139010905724e-18};
  Split a = split(x);
  if (a.m >= 1.73205080756887729353) {  // sqrt 3
    a.m *= 0.5;
    ++a.k;
  }
  const bool about_one = a.m < 1.22474487139158904910;  // sqrt(3/2)
  const double c = about_one ? 1.0 : 1.5;
  const DoubleDouble s = DoubleDouble{a.m - c, 0.0} / two_sum(a.m, c);
  const DoubleDouble s2 = s * s;
  const double z = s2.hi;
  const double tail = z * z * (kL1 + z * (kL2 + z * (kL3 + z * (kL4 + z * (kL5 + z * kL6)))));
  const DoubleDouble sum = two_sum(3.0, s2.hi);
  const DoubleDouble series = s * fast_two_sum(sum.hi, sum.lo + (s2.lo + tail)) * kTwoThirdsInvLn2;
  const DoubleDouble whole = {static_cast<double>(a.k), 0.0};
  return about_one ? whole + series : whole + (kLog2OfThreeHalves + series);
}

// Where there is nothing to compute: log 0, log of infinity, of a negative number, of NaN.
bool is_positive_finite(double x) { return x > 0.0 && x < kInf; }
double log_of_special(double x) { return x == 0.0 ? -kInf : x > 0.0 ? kInf : kNan; }

}  // namespace

double exp(double x) {
  if (x != x) return x;
  if (x > 709.782712893383973096) return kInf;
  if (x < -745.2) return 0.0;
  const double k = std::floor(x * kInvLn2 + 0.5);
  return scale(exp_kernel({x - k * kLn2Hi, -k * kLn2Lo}), static_cast<int>(k));
}

double exp2(double x) {
  if (x != x) return x;
  if (x >= 1024.0) return kInf;
  if (x < -1076.0) return 0.0;
  return exp2_kernel({x, 0.0});
}

double expm1(double x) {
  constexpr double kQ1 = -3.33333333333331316428e-02, kQ2 = 1.58730158725481460165e-03,
                   kQ3 = -7.93650757867487942473e-05, kQ4 = 4.00821782732936239552e-06,
                   kQ5 = -2.01099218183624371326e-07;
  if (x != x) return x;
  if (x > 709.782712893383973096) return kInf;
  if (x < -40.0) return -1.0;
  if (std::fabs(x) < 0x1p-54) return x;  // also keeps the sign of -0
  const double k = std::floor(x * kInvLn2 + 0.5);
  const DoubleDouble r = two_sum(x - k * kLn2Hi, -k * kLn2Lo);
  // expm1(r) = r + half_square - ..., a rational form that keeps the leading terms apart.
  const double half = 0.5 * r.hi, half_square = r.hi * half;
  const double a =
      1.0 + half_square * (kQ1 + half_square * (kQ2 + half_square * (kQ3 + half_square * (kQ4 + half_square * kQ5))));
  const double b = 3.0 - a * half;
  const double e = half_square * ((a - b) / (6.0 - r.hi * b));
  const double expm1_r = r.hi - ((r.hi * e - (r.lo + r.lo * r.hi)) - half_square);
  if (k == 0.0) return expm1_r;
  const int n = static_cast<int>(k);
  return scale((1.0 - scale(1.0, -n)) + expm1_r, n);
}

double log(double x) {
  if (!is_positive_finite(x)) return log_of_special(x);
  const Split s = split_about_one(x);
  return log_sum(s.m - 1.0, s.k, 0.0);
}

double log2(double x) {
  if (!is_positive_finite(x)) return log_of_special(x);
  const DoubleDouble wide = log2_wide(x);
  return wide.hi + wide.lo;
}

double log1p(double x) {
  if (!is_positive_finite(x + 1.0)) return log_of_special(x + 1.0);
  if (std::fabs(x) < 0x1p-54) return x;
  const DoubleDouble sum = two_sum(1.0, x);
  const Split s = split_about_one(sum.hi);
  // Near 1 the argument itself is exact; elsewhere what 1 + x lost comes back as a first-order term.
  return s.k == 0 ? log_sum(x, 0, 0.0) : log_sum(s.m - 1.0, s.k, sum.lo / sum.hi);
}

double pow(double x, double y) {
  if (y == 0.0 || x == 1.0) return 1.0;
  if (x != x || y != y || x < 0.0) return kNan;
  if (x == 0.0 || x == kInf) return (x == 0.0) == (y > 0.0) ? 0.0 : kInf;
  if (std::fabs(y) > 0x1p80) return (x > 1.0) == (y > 0.0) ? kInf : 0.0;  // the smallest |log2 x| is 2^-53
  if (y == 1.0) return x;
  const DoubleDouble e = log2_wide(x) * DoubleDouble{y, 0.0};
  if (e.hi >= 1024.0 || (e.hi == 1024.0 && e.lo >= 0.0)) return kInf;
  if (e.hi < -1076.0) return 0.0;
  return exp2_kernel(e);
}

}  // namespace tilelight::elementary
