// SPDX-License-Identifier: Apache-2.0
// The error by pixel, to look at.
#pragma once

#include <vector>

#include "renderer/film/film.h"

namespace tilelight {

// bounds: by pixel, as ErrorMap::bounds() gives them. As linear grey, for formats of numbers.
Image error_image(int width, int height, const std::vector<float>& bounds);

// In false colours: black up to a quarter of a step of 8 bits, then on a logarithmic scale purple at 1/255, red at
// 6/255, orange at 16/255, and pale yellow from 64/255 on. Shown as meant at exposure 0.
Image heat_map(int width, int height, const std::vector<float>& bounds);

}  // namespace tilelight
