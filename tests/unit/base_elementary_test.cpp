// SPDX-License-Identifier: Apache-2.0
// Our elementary functions against the long double ones of the C library (64 bits of significand on x86), in units of
// the last place of the double result.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>

#include "renderer/base/elementary.h"
#include "renderer/base/hash.h"

namespace tilelight {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr int kSamples = 200'000;

double ulp_of(double x) {
  const double a = std::fabs(x);
  return std::nextafter(a, kInf) - a;
}

double ulp_error(double found, long double expected) {
  const double rounded = static_cast<double>(expected);
  if (found == rounded) return std::fabs(static_cast<double>(found - expected)) / ulp_of(rounded);
  return std::fabs(static_cast<double>((found - expected) / ulp_of(rounded)));
}

// A number in [0, 1) of a fixed sequence.
double unit(uint64_t i) { return static_cast<double>(mix64(i) >> 11) * 0x1p-53; }

// The worst error over arguments spread evenly and over arguments spread by magnitude.
struct Worst {
  double ulps = 0.0, at = 0.0;
};
Worst worst_error(const std::function<double(double)>& f, const std::function<long double(long double)>& truth,
                  double lo, double hi, double smallest = 1e-300) {
  Worst worst;
  auto probe = [&](double x) {
    if (!(x >= lo && x <= hi)) return;
    const double error = ulp_error(f(x), truth(x));
    if (!(error <= worst.ulps)) worst = {error, x};
  };
  const double span = std::log2(std::max(std::fabs(lo), std::fabs(hi)) / smallest);
  for (int i = 0; i < kSamples; ++i) {
    probe(lo + (hi - lo) * unit(2 * i));
    const double magnitude = smallest * std::exp2(span * unit(2 * i + 1));
    probe(magnitude);
    probe(-magnitude);
  }
  probe(lo), probe(hi);
  return worst;
}

#define EXPECT_WORST(bound, ...)                                        \
  do {                                                                  \
    const Worst worst = worst_error(__VA_ARGS__);                       \
    EXPECT_LE(worst.ulps, bound) << "at " << std::hexfloat << worst.at; \
    RecordProperty("worst_ulps", std::to_string(worst.ulps));           \
  } while (false)

TEST(Elementary, SineIsWithinOneUlpUpToAMillionRadians) {
  EXPECT_WORST(
      1.0, elementary::sin, [](long double x) { return sinl(x); }, -1e6, 1e6);
}
TEST(Elementary, CosineIsWithinOneUlpUpToAMillionRadians) {
  EXPECT_WORST(
      1.0, elementary::cos, [](long double x) { return cosl(x); }, -1e6, 1e6);
}
TEST(Elementary, TangentIsWithinTwoUlpUpToAMillionRadians) {
  EXPECT_WORST(
      2.0, elementary::tan, [](long double x) { return tanl(x); }, -1e6, 1e6);
}
TEST(Elementary, SineAndCosineHoldBesideEveryMultipleOfAQuarterTurn) {
  for (int n = 1; n < 600'000; n += 7) {
    const double x = static_cast<double>(n * 1.57079632679489661923132169163975144L);
    ASSERT_LE(ulp_error(elementary::sin(x), sinl(x)), 1.0) << n;
    ASSERT_LE(ulp_error(elementary::cos(x), cosl(x)), 1.0) << n;
  }
}
TEST(Elementary, SineBeyondItsDomainStaysASine) {
  for (double x : {1e7, 1e15, 1e300, -1e300}) EXPECT_LE(std::fabs(elementary::sin(x)), 1.0) << x;
  EXPECT_TRUE(std::isnan(elementary::sin(kInf)));
  EXPECT_TRUE(std::isnan(elementary::cos(std::nan(""))));
}
TEST(Elementary, ArcCosineIsWithinOneUlp) {
  EXPECT_WORST(
      1.0, elementary::acos, [](long double x) { return acosl(x); }, -1.0, 1.0);
}
TEST(Elementary, ArcCosineOutsideItsDomainIsTheNearestEnd) {
  EXPECT_EQ(elementary::acos(1.0 + 1e-9), 0.0);
  EXPECT_EQ(elementary::acos(-1.0 - 1e-9), elementary::kPi);
}
TEST(Elementary, ArcTangentOfTwoIsWithinTwoUlpInEveryQuadrant) {
  double worst = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double y = (unit(4 * i) - 0.5) * std::exp2(40.0 * (unit(4 * i + 1) - 0.5));
    const double x = (unit(4 * i + 2) - 0.5) * std::exp2(40.0 * (unit(4 * i + 3) - 0.5));
    worst = std::max(worst, ulp_error(elementary::atan2(y, x), atan2l(y, x)));
  }
  EXPECT_LE(worst, 2.0);
}
TEST(Elementary, ArcTangentOfTwoKnowsTheAxesAndTheSignedZeros) {
  for (double y : {0.0, -0.0, 1.0, -1.0, kInf, -kInf})
    for (double x : {0.0, -0.0, 1.0, -1.0, kInf, -kInf})
      EXPECT_EQ(elementary::atan2(y, x), std::atan2(y, x)) << y << " " << x;
}
TEST(Elementary, ExponentialIsWithinOneUlp) {
  EXPECT_WORST(
      1.0, elementary::exp, [](long double x) { return expl(x); }, -745.0, 709.7);
}
TEST(Elementary, ExponentialOfTwoIsWithinOneUlp) {
  EXPECT_WORST(
      1.0, elementary::exp2, [](long double x) { return exp2l(x); }, -1074.5, 1023.99);
}
TEST(Elementary, ExponentialMinusOneIsWithinTwoUlp) {
  EXPECT_WORST(
      2.0, elementary::expm1, [](long double x) { return expm1l(x); }, -745.0, 709.7);
  EXPECT_WORST(
      2.0, elementary::expm1, [](long double x) { return expm1l(x); }, -2.0, 2.0);
}
TEST(Elementary, LogarithmIsWithinOneUlp) {
  EXPECT_WORST(
      1.0, elementary::log, [](long double x) { return logl(x); }, 5e-324, 1.7e308, 5e-324);
  EXPECT_WORST(
      1.0, elementary::log, [](long double x) { return logl(x); }, 0.5, 2.0);
}
TEST(Elementary, LogarithmToBaseTwoIsWithinOneUlp) {
  EXPECT_WORST(
      1.0, elementary::log2, [](long double x) { return log2l(x); }, 5e-324, 1.7e308, 5e-324);
  EXPECT_WORST(
      1.0, elementary::log2, [](long double x) { return log2l(x); }, 0.5, 2.0);
  for (int k = -1074; k < 1024; ++k) ASSERT_EQ(elementary::log2(std::ldexp(1.0, k)), k);
}
TEST(Elementary, LogarithmOfOnePlusIsWithinTwoUlp) {
  EXPECT_WORST(
      2.0, elementary::log1p, [](long double x) { return log1pl(x); }, -0.999999, 1e300);
  EXPECT_WORST(
      2.0, elementary::log1p, [](long double x) { return log1pl(x); }, -0.999999, 4.0);
}
TEST(Elementary, PowerIsWithinOneUlpOverTheWholeRangeOfResults) {
  double worst = 0.0, worst_x = 0.0, worst_y = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double x = i % 2 ? 0.5 + unit(3 * i) : std::exp2(600.0 * (unit(3 * i) - 0.5));
    const double y =
        (unit(3 * i + 1) - 0.5) * 2.0 * 1020.0 / std::fabs(std::log2(x)) * std::exp2(-20.0 * unit(3 * i + 2));
    const long double truth = powl(x, y);
    if (!(truth > 1e-307L && truth < 1.7e308L)) continue;
    const double error = ulp_error(elementary::pow(x, y), truth);
    if (error > worst) worst = error, worst_x = x, worst_y = y;
  }
  EXPECT_LE(worst, 1.0) << std::hexfloat << worst_x << " " << worst_y;
}
TEST(Elementary, PowerOfWholeNumbersIsExactWhereADoubleHoldsIt) {
  for (int base = 2; base <= 12; ++base) {
    double product = 1.0;
    for (int n = 0; product < 0x1p53; ++n, product *= base) EXPECT_EQ(elementary::pow(base, n), product) << base << n;
  }
}
TEST(Elementary, SpecialValuesAgreeWithTheCLibrary) {
  for (double x : {0.0, 5e-324, 0.5, 1.0, 2.0, 1e308, kInf}) {
    for (double y : {-kInf, -1e300, -2.5, -1.0, -0.0, 0.0, 1.0, 2.5, 1e300, kInf}) {
      EXPECT_DOUBLE_EQ(elementary::pow(x, y), std::pow(x, y)) << x << " " << y;
    }
  }
  EXPECT_EQ(elementary::exp(0.0), 1.0);
  EXPECT_EQ(elementary::exp(710.0), kInf);
  EXPECT_EQ(elementary::exp(-kInf), 0.0);
  EXPECT_EQ(elementary::exp2(1024.0), kInf);
  EXPECT_EQ(elementary::exp2(10.0), 1024.0);
  EXPECT_EQ(elementary::expm1(-kInf), -1.0);
  EXPECT_EQ(elementary::log(0.0), -kInf);
  EXPECT_EQ(elementary::log(1.0), 0.0);
  EXPECT_EQ(elementary::log(kInf), kInf);
  EXPECT_TRUE(std::isnan(elementary::log(-1.0)));
  EXPECT_EQ(elementary::log1p(-1.0), -kInf);
  EXPECT_TRUE(std::signbit(elementary::sin(-0.0)) && std::signbit(elementary::expm1(-0.0)));
}

// The promise is equal bits on every CPU: a fold over many results, written down once. A change of any last bit
// anywhere shows here, whatever machine runs the test.
TEST(Elementary, EveryBitIsTheSameOnEveryMachine) {
  uint64_t fold = 0;
  auto add = [&](double value) { fold = mix64(fold ^ std::bit_cast<uint64_t>(value)); };
  for (int i = 0; i < 20'000; ++i) {
    const double u = unit(i), x = (u - 0.5) * 200.0;
    add(elementary::sin(x)), add(elementary::cos(x)), add(elementary::tan(x)), add(elementary::acos(2.0 * u - 1.0));
    add(elementary::atan2(x, u)), add(elementary::exp(x)), add(elementary::exp2(x)), add(elementary::expm1(x));
    add(elementary::log(u)), add(elementary::log2(u)), add(elementary::log1p(u)), add(elementary::pow(u, x));
  }
  EXPECT_EQ(fold, 0xdd0e4cc837c2a7e2ull) << std::hex << fold;
}

}  // namespace
}  // namespace tilelight
