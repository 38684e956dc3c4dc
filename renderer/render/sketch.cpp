// SPDX-License-Identifier: Apache-2.0
#include "renderer/render/sketch.h"

#include <algorithm>

namespace tilelight {
namespace {

// Along an axis of `size` pixels: the traced pixels on both sides of one, and how far it is from the first to the
// second.
struct Between {
  int first, second;
  float part;
};
int traced_in(int cell, int size) { return std::min(cell * kCellPx + 1, size - 1); }

Between between(int pixel, int size) {
  const int last_cell = (size - 1) / kCellPx;
  int cell = pixel / kCellPx;
  if (pixel < traced_in(cell, size)) --cell;
  const int first = traced_in(std::max(cell, 0), size), second = traced_in(std::min(cell + 1, last_cell), size);
  const int distance = second - first;  // 0 before the first one and after the last
  return {first, second, distance > 0 ? static_cast<float>(pixel - first) / static_cast<float>(distance) : 0.0f};
}

}  // namespace

TileRect Sketch::pixel_of(const TileRect& cell) {
  const int x = std::min(cell.x0 + 1, cell.x1 - 1), y = std::min(cell.y0 + 1, cell.y1 - 1);
  return {x, y, x + 1, y + 1};
}

void Sketch::fill(const TileRect& part, Image& image) const {
  const float* traced = film_.planes()[0];
  const int width = film_.width(), height = film_.height();
  for_each_pixel(part, [&](int x, int y) {
    const Between across = between(x, width), down = between(y, height);
    const auto at = [&](int u, int v, size_t channel) {
      return traced[(static_cast<size_t>(v) * width + u) * 3 + channel];
    };
    for (size_t channel = 0; channel < 3; ++channel) {
      const auto row = [&](int v) {
        const float a = at(across.first, v, channel), b = at(across.second, v, channel);
        return a + across.part * (b - a);
      };
      const float above = row(down.first), below = row(down.second);
      image.rgb[(static_cast<size_t>(y) * width + x) * 3 + channel] = above + down.part * (below - above);
    }
  });
}

}  // namespace tilelight
