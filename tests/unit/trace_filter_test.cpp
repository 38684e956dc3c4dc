// SPDX-License-Identifier: Apache-2.0
// Pixel filters: where samples fall, against the filters' own distribution functions.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "renderer/trace/pixel_filter.h"

namespace tilelight {
namespace {

// The share of the filter's weight left of an offset from the pixel's middle, pixels.
double tent_share(double t) { return t < 0.0 ? 0.5 * (1.0 + t) * (1.0 + t) : 1.0 - 0.5 * (1.0 - t) * (1.0 - t); }

double gaussian_share(double t) {
  const auto normal = [](double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); };
  return (normal(t / 0.5) - normal(-3.0)) / (normal(3.0) - normal(-3.0));
}

TEST(PixelFilter, PutsItsSamplesWhereItsWeightIs) {
  const std::pair<PixelFilter, std::function<double(double)>> filters[] = {
      {PixelFilter::box, [](double t) { return 0.5 + t; }},
      {PixelFilter::tent, tent_share},
      {PixelFilter::gaussian, gaussian_share}};
  for (const auto& [filter, share] : filters) {
    for (int i = 0; i <= 1000; ++i) {
      const double u = i == 1000 ? 1.0 - 0x1p-32 : i / 1000.0;
      const SamplePoint p = through_filter(filter, {u, 1.0 - u});
      EXPECT_NEAR(share(p.x - 0.5), u, 1e-8);
      EXPECT_NEAR(share(p.y - 0.5), 1.0 - u, 1e-8);
      EXPECT_GE(p.x, -kFilterReachPx);
      EXPECT_LE(p.x, 1.0 + kFilterReachPx);
    }
  }
}

}  // namespace
}  // namespace tilelight
