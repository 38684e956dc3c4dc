// SPDX-License-Identifier: Apache-2.0
#include "renderer/measure/ssim.h"

#include "renderer/base/elementary.h"
#include "renderer/measure/planes.h"

namespace tilelight {
namespace {

Plane luma(const DisplayedImage& image) {
  Plane out{image.width, image.height, std::vector<double>(image.rgb.size() / 3)};
  for (size_t i = 0; i < out.values.size(); ++i)
    out.values[i] = 0.299 * image.rgb[3 * i] + 0.587 * image.rgb[3 * i + 1] + 0.114 * image.rgb[3 * i + 2];
  return out;
}

Taps gaussian_window() {
  constexpr int kReach = 5;
  constexpr double kDeviation = 1.5;
  Taps taps;
  double sum = 0.0;
  for (int i = -kReach; i <= kReach; ++i) {
    taps.push_back(elementary::exp(-0.5 * i * i / (kDeviation * kDeviation)));
    sum += taps.back();
  }
  for (double& tap : taps) tap /= sum;
  return taps;
}

}  // namespace

double ssim(const DisplayedImage& a, const DisplayedImage& b) {
  constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;  // of the paper, for values in [0, 1]
  const Taps window = gaussian_window();
  const Plane x = luma(a), y = luma(b);
  const auto mean_of_product = [&](const Plane& p, const Plane& q) {
    Plane product = p;
    for (size_t i = 0; i < p.values.size(); ++i) product.values[i] *= q.values[i];
    return convolved(product, window, window);
  };
  const Plane mean_x = convolved(x, window, window), mean_y = convolved(y, window, window);
  const Plane xx = mean_of_product(x, x), yy = mean_of_product(y, y), xy = mean_of_product(x, y);
  double sum = 0.0;
  for (size_t i = 0; i < x.values.size(); ++i) {
    const double mx = mean_x.values[i], my = mean_y.values[i];
    const double variance_x = xx.values[i] - mx * mx, variance_y = yy.values[i] - my * my;
    const double covariance = xy.values[i] - mx * my;
    sum += (2.0 * mx * my + kC1) * (2.0 * covariance + kC2) /
           ((mx * mx + my * my + kC1) * (variance_x + variance_y + kC2));
  }
  return sum / static_cast<double>(x.values.size());
}

}  // namespace tilelight
