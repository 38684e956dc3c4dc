// SPDX-License-Identifier: Apache-2.0
// Elementary functions that give the same bits on every CPU. glibc's sin, exp, pow, ... choose code by CPU (with and
// without FMA) and differ in the last bits; whatever reaches the image uses these instead. Only +, -, *, /, sqrt and
// integer operations inside, each exactly rounded by IEEE 754. Accuracy: under 2 ulp on the stated domain (tested
// against long double). Pure; any thread.
#pragma once

namespace tilelight::elementary {

inline constexpr double kPi = 3.14159265358979323846;

double sin(double rad);   // |rad| <= 1e6
double cos(double rad);   // |rad| <= 1e6
double tan(double rad);   // |rad| <= 1e6
double acos(double x);    // [-1, 1]; outside it the nearest end
double atan2(double y, double x);
double exp(double x);     // 0 under -745, +inf over 709.78
double log(double x);     // x > 0; -inf at 0; NaN under 0
double exp2(double x);
double log2(double x);
double log1p(double x);   // x > -1
double expm1(double x);
double pow(double x, double y);  // x >= 0; pow(0, 0) = 1

inline double rad_from_deg(double deg) { return deg * (kPi / 180.0); }

}  // namespace tilelight::elementary
