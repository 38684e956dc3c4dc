// SPDX-License-Identifier: Apache-2.0
// The pixel filter, by importance: samples lie as thickly as the filter weighs, so that a pixel stays the plain mean of
// its own samples (Ernst, Stamminger, Greiner 2006, "Filter importance sampling"). Pure.
#pragma once

#include <vector>

#include "renderer/film/film.h"
#include "renderer/film/sampling.h"
#include "renderer/scene/scene.h"

namespace tilelight {

// How far a pixel's samples may lie outside it, pixels.
inline constexpr int kFilterReachPx = 1;

// A point of [0, 1)^2, uniform, to where the filter has it, relative to the pixel's first corner. box: inside the
// pixel. tent: up to a pixel from its middle. gaussian: of standard deviation half a pixel, up to 1.5 from the middle.
SamplePoint through_filter(PixelFilter filter, SamplePoint point);

// Where sample `index` of the pixel lies, relative to the pixel's first corner. Views that are drawn from triangles
// have their samples on a grid of 1/256 pixel, so that edge functions of corners on that grid are exact.
inline constexpr double kSubpixels = 256.0;
SamplePoint place_sample(const RenderSpec& spec, int x, int y, uint32_t index);

// Points of the image, in pixels from its top left corner, in columns.
struct ImagePoints {
  std::vector<double> x, y;
  size_t size() const { return x.size(); }
  void clear() { x.clear(), y.clear(); }
};

// Appends where sample `index` of every pixel lies, row by row.
void place_cell(const RenderSpec& spec, const TileRect& rect, uint32_t index, ImagePoints& points);

}  // namespace tilelight
