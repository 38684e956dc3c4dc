// SPDX-License-Identifier: Apache-2.0
#include "renderer/measure/image_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "renderer/base/elementary.h"
#include "renderer/film/tone.h"
#include "renderer/measure/flip.h"
#include "renderer/measure/ssim.h"

namespace tilelight {
namespace {

double relative_mse(const Image& tested, const Image& truth, double exposure_stops) {
  constexpr double kFloor = 0.01;
  const double scale = elementary::exp2(exposure_stops);
  double sum = 0.0;
  for (size_t i = 0; i < truth.rgb.size(); ++i) {
    const double real = scale * truth.rgb[i], off = scale * tested.rgb[i] - real;
    sum += off * off / (real * real + kFloor);
  }
  return sum / static_cast<double>(truth.rgb.size());
}

// The value that a part of all are at most. REQUIRES: values is not empty.
double quantile(std::vector<float> values, double part) {
  const auto at = static_cast<int64_t>(std::ceil(part * static_cast<double>(values.size()))) - 1;
  const auto place = values.begin() + std::max<int64_t>(0, at);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace

DisplayedImage displayed_image(const Image& linear, double exposure_stops) {
  DisplayedImage out{linear.width, linear.height, std::vector<float>(linear.rgb.size())};
  std::transform(linear.rgb.begin(), linear.rgb.end(), out.rgb.begin(),
                 [=](float v) { return static_cast<float>(displayed(v, exposure_stops)); });
  return out;
}

std::vector<float> error_by_pixel(const DisplayedImage& tested, const DisplayedImage& truth) {
  std::vector<float> out(truth.rgb.size() / 3);
  for (size_t pixel = 0; pixel < out.size(); ++pixel) {
    double sum = 0.0;
    for (size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
      const double off = static_cast<double>(tested.rgb[i]) - truth.rgb[i];
      sum += off * off;
    }
    out[pixel] = static_cast<float>(std::sqrt(sum / 3.0));
  }
  return out;
}

double rms_difference(const DisplayedImage& a, const DisplayedImage& b) {
  const double sum = std::transform_reduce(a.rgb.begin(), a.rgb.end(), b.rgb.begin(), 0.0, std::plus<>(),
                                           [](double x, double y) { return (x - y) * (x - y); });
  return std::sqrt(sum / static_cast<double>(a.rgb.size()));
}

double psnr_db(double rmse) {
  return rmse > 0.0 ? -20.0 * elementary::log2(rmse) / elementary::log2(10.0) : std::numeric_limits<double>::infinity();
}

ImageError image_error(const Image& tested, const Image& truth, double exposure_stops) {
  const DisplayedImage ours = displayed_image(tested, exposure_stops), real = displayed_image(truth, exposure_stops);
  const std::vector<float> by_pixel = error_by_pixel(ours, real);
  ImageError out;
  out.rmse = rms_difference(ours, real);
  out.p99 = quantile(by_pixel, 0.99);
  out.most = *std::max_element(by_pixel.begin(), by_pixel.end());
  out.rel_mse = relative_mse(tested, truth, exposure_stops);
  out.psnr_db = psnr_db(out.rmse);
  out.ssim = ssim(ours, real);
  out.flip = mean_flip(ours, real);
  return out;
}

}  // namespace tilelight
