// SPDX-License-Identifier: Apache-2.0
// From linear light to what a display shows: clamp(I * 2^exposure, 0, 1), then the sRGB curve (IEC 61966-2-1), no
// other.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/film/film.h"

namespace tilelight {

double srgb_from_linear(double linear);  // [0,1] -> [0,1]
double linear_from_srgb(double srgb);    // [0,1] -> [0,1]

// Displayed value in [0,1] of a linear value. NaN gives 0.
double displayed(double linear, double exposure_stops);

// 8-bit sRGB, width * height * 3 bytes, rounded half up. The same bytes on every CPU.
std::vector<uint8_t> to_srgb8(const Image& image, double exposure_stops);

}  // namespace tilelight
