// SPDX-License-Identifier: Apache-2.0
#include "renderer/film/film.h"

namespace tilelight {
namespace {

int tiles_across(int pixels, int tile_px) { return (pixels + tile_px - 1) / tile_px; }

}  // namespace

int tile_count(int width, int height, int tile_px) {
  return tiles_across(width, tile_px) * tiles_across(height, tile_px);
}

TileRect tile_rect(int index, int width, int height, int tile_px) {
  const int columns = tiles_across(width, tile_px);
  const int x0 = index % columns * tile_px, y0 = index / columns * tile_px;
  return {x0, y0, std::min(x0 + tile_px, width), std::min(y0 + tile_px, height)};
}

Image Film::resolve(int samples) const {
  Image image{width_, height_, std::vector<float>(sums_.size())};
  // Division, not a product with 1/samples: that would be rounded twice.
  const float n = static_cast<float>(samples);
  std::transform(sums_.begin(), sums_.end(), image.rgb.begin(), [n](float sum) { return sum / n; });
  return image;
}

}  // namespace tilelight
