// SPDX-License-Identifier: Apache-2.0
// Sketch: a picture by one pixel of every cell of the film, for renders whose time may not suffice for all pixels. It
// traces sample 0 of that pixel, and is no part of the film.
#pragma once

#include "renderer/film/film.h"

namespace tilelight {

class Sketch {
 public:
  Sketch(int width, int height) : film_(width, height) { film_.grow(1); }
  TileView view() { return film_.view(); }
  // The pixel that stands for the cell.
  static TileRect pixel_of(const TileRect& cell);
  // Writes the part of the image, bilinear between the pixels that were traced. Parts may be done by many threads.
  // REQUIRES: every cell's pixel was traced; an image of the sketch's size.
  void fill(const TileRect& part, Image& image) const;

 private:
  Film film_;
};

}  // namespace tilelight
