// SPDX-License-Identifier: Apache-2.0
// How far a picture is from the true one, in the numbers that the field uses. All but relMSE compare what a display
// shows: clamped, on the sRGB curve, black 0 and white 1. Pure; any thread.
#pragma once

#include <vector>

#include "renderer/film/film.h"

namespace tilelight {

// As displayed: width * height * 3 values in [0, 1], row by row from the top.
struct DisplayedImage {
  int width = 0, height = 0;  // pixels
  std::vector<float> rgb;
};
DisplayedImage displayed_image(const Image& linear, double exposure_stops);

struct ImageError {
  double rmse = 0.0;     // over pixels and channels
  double p99 = 0.0;      // 99 % of pixels are off by less: root mean square over their channels
  double most = 0.0;     // of the pixel that is off most
  double rel_mse = 0.0;  // mean of (v - true)^2 / (true^2 + 0.01), linear light times 2^exposure
  double psnr_db = 0.0;  // -20 log10(rmse); +inf where equal
  double ssim = 0.0;     // mean structural similarity of luma (Wang et al. 2004); 1 where equal
  double flip = 0.0;     // mean of the FLIP map (Andersson et al. 2020); 0 where equal
};

// REQUIRES: images of one size.
ImageError image_error(const Image& tested, const Image& truth, double exposure_stops);

// The root mean square of a - b. REQUIRES: images of one size.
double rms_difference(const DisplayedImage& a, const DisplayedImage& b);

double psnr_db(double rmse);

// Per pixel: root mean square over its channels.
std::vector<float> error_by_pixel(const DisplayedImage& tested, const DisplayedImage& truth);

}  // namespace tilelight
