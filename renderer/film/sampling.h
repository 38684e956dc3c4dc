// SPDX-License-Identifier: Apache-2.0
// The sampling pattern: two-dimensional Sobol points with Owen scrambling by hash (Laine and Karras 2011; Burley 2020,
// JCGT 9(4)), one sequence a pixel. Point i of a pixel depends on (pixel, seed, i) alone. Pure; any thread.
#pragma once

#include <cstdint>

namespace tilelight {

struct SamplePoint {
  double x, y;  // inside the pixel, [0, 1)
};

// The sequence of the pixel (x, y). Uniform over the pixel; trace/pixel_filter.h bends it to another filter.
SamplePoint sample_point(int x, int y, uint32_t seed, uint32_t index);

}  // namespace tilelight
