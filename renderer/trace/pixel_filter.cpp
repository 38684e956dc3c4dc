// SPDX-License-Identifier: Apache-2.0
#include "renderer/trace/pixel_filter.h"

#include <cmath>

#include "renderer/base/elementary.h"

namespace tilelight {
namespace {

// Offset from the pixel's middle.
double tent_offset(double u) { return u < 0.5 ? std::sqrt(2.0 * u) - 1.0 : 1.0 - std::sqrt(2.0 - 2.0 * u); }

// The quantile of the normal distribution to 1.15e-9 relative; P. J. Acklam's rational approximation (2003).
double normal_quantile(double p) {
  if (p > 0.5) return -normal_quantile(1.0 - p);
  if (p < 0.02425) {
    const double q = std::sqrt(-2.0 * elementary::log(p));
    return (((((-7.784894002430293e-03 * q - 3.223964580411365e-01) * q - 2.400758277161838e+00) * q -
              2.549732539343734e+00) *
                 q +
             4.374664141464968e+00) *
                q +
            2.938163982698783e+00) /
           ((((7.784695709041462e-03 * q + 3.224671290700398e-01) * q + 2.445134137142996e+00) * q +
             3.754408661907416e+00) *
                q +
            1.0);
  }
  const double q = p - 0.5, r = q * q;
  return (((((-3.969683028665376e+01 * r + 2.209460984245205e+02) * r - 2.759285104469687e+02) * r +
            1.383577518672690e+02) *
               r -
           3.066479806614716e+01) *
              r +
          2.506628277459239e+00) *
         q /
         (((((-5.447609879822406e+01 * r + 1.615858368580409e+02) * r - 1.556989798598866e+02) * r +
            6.680131188771972e+01) *
               r -
           1.328068155288572e+01) *
              r +
          1.0);
}

double gaussian_offset(double u) {
  constexpr double kDeviation = 0.5;              // pixels
  constexpr double kCut = 0.0013498980316300933;  // what lies beyond three deviations, each side
  return kDeviation * normal_quantile(kCut + u * (1.0 - 2.0 * kCut));
}

}  // namespace

SamplePoint through_filter(PixelFilter filter, SamplePoint point) {
  switch (filter) {
    case PixelFilter::box:
      break;
    case PixelFilter::tent:
      return {0.5 + tent_offset(point.x), 0.5 + tent_offset(point.y)};
    case PixelFilter::gaussian:
      return {0.5 + gaussian_offset(point.x), 0.5 + gaussian_offset(point.y)};
  }
  return point;
}

SamplePoint place_sample(const RenderSpec& spec, int x, int y, uint32_t index) {
  const SamplePoint p = through_filter(spec.filter, sample_point(x, y, spec.seed, index));
  if (!is_tessellated(spec)) return p;
  return {std::floor(p.x * kSubpixels) / kSubpixels, std::floor(p.y * kSubpixels) / kSubpixels};
}

}  // namespace tilelight
