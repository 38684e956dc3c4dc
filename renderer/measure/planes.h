// SPDX-License-Identifier: Apache-2.0
// One channel of an image, and convolutions of it. Pure.
#pragma once

#include <vector>

namespace tilelight {

struct Plane {
  int width = 0, height = 0;
  std::vector<double> values;  // row by row
};

// An odd number of weights, the middle one at the pixel itself.
using Taps = std::vector<double>;

// Weights along x, then along y; beyond the edges the nearest pixel stands for what is not there.
Plane convolved(const Plane& plane, const Taps& along_x, const Taps& along_y);

}  // namespace tilelight
