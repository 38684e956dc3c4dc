// SPDX-License-Identifier: Apache-2.0
// LineInk: whether a point of the image lies on a drawn line. Sampled several times a pixel it gives the drawing
// antialiased. Pixels. Immutable after construction; any thread may read.
#pragma once

#include <vector>

#include "renderer/raster/lines/line_drawing.h"

namespace tilelight {

class LineInk {
 public:
  explicit LineInk(const LineDrawing& drawing);

  // Lines have round ends; dashes square ones. Outside of the image nothing is inked.
  bool is_inked(double x, double y) const;

 private:
  struct Stroke {
    Vec2 from, way;  // way: unit
    double length, half_width;
    double along;  // of `from` in its dashes; negative: no dashes
  };
  static bool is_on(const Stroke& stroke, const Vec2& p);

  int width_, height_, columns_, rows_;
  std::vector<uint32_t> begins_;  // of the tiles, row by row
  std::vector<Stroke> strokes_;   // by tile; one that lies in several is there several times
};

}  // namespace tilelight
