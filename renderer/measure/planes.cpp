// SPDX-License-Identifier: Apache-2.0
#include "renderer/measure/planes.h"

#include <algorithm>
#include <cstddef>

namespace tilelight {
namespace {

// Of a line of `count` values, `stride` apart.
void convolve_line(const double* from, double* to, int count, int stride, const Taps& taps) {
  const int reach = static_cast<int>(taps.size() / 2);
  for (int i = 0; i < count; ++i) {
    double sum = 0.0;
    for (int t = -reach; t <= reach; ++t)
      sum += taps[static_cast<size_t>(t + reach)] *
             from[static_cast<std::ptrdiff_t>(std::clamp(i + t, 0, count - 1)) * stride];
    to[static_cast<std::ptrdiff_t>(i) * stride] = sum;
  }
}

}  // namespace

Plane convolved(const Plane& plane, const Taps& along_x, const Taps& along_y) {
  Plane rows = plane, out = plane;
  for (int y = 0; y < plane.height; ++y) {
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(y) * plane.width;
    convolve_line(plane.values.data() + first, rows.values.data() + first, plane.width, 1, along_x);
  }
  for (int x = 0; x < plane.width; ++x)
    convolve_line(rows.values.data() + x, out.values.data() + x, plane.height, plane.width, along_y);
  return out;
}

}  // namespace tilelight
