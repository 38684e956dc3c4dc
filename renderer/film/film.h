// SPDX-License-Identifier: Apache-2.0
// Film: the sum of the samples of every pixel, linear RGB. Work items write disjoint TileViews from many threads
// without locks; the film adds samples in index order, so any split of the same total gives the same bytes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace tilelight {

struct TileRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // pixels, half open
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  int64_t pixel_count() const { return static_cast<int64_t>(width()) * height(); }
};

// visit(x, y) for every pixel, in squares of 4 by 4: neighbours in this order are neighbours in the image.
template <class Visit>
void for_each_in_squares(const TileRect& rect, const Visit& visit) {
  constexpr int kSquarePx = 4;
  for (int top = rect.y0; top < rect.y1; top += kSquarePx) {
    for (int left = rect.x0; left < rect.x1; left += kSquarePx) {
      for (int y = top; y < std::min(top + kSquarePx, rect.y1); ++y)
        for (int x = left; x < std::min(left + kSquarePx, rect.x1); ++x) visit(x, y);
    }
  }
}

// The rectangles of a grid of tiles with edge tile_px over the image, row by row. Pure.
int tile_count(int width, int height, int tile_px);
TileRect tile_rect(int index, int width, int height, int tile_px);

// A linear image: width * height * 3 floats, RGB, row by row from the top.
struct Image {
  int width = 0, height = 0;  // pixels
  std::vector<float> rgb;
};

// A work item's own window on the film. Threads: one at a time per pixel.
class TileView {
 public:
  TileView(float* sums, int film_width, TileRect rect) : sums_(sums), film_width_(film_width), rect_(rect) {}
  const TileRect& rect() const { return rect_; }
  // REQUIRES: (x, y) inside rect(), film coordinates. Adds one sample.
  void add(int x, int y, float r, float g, float b) {
    float* p = sums_ + (static_cast<size_t>(y) * film_width_ + x) * 3;
    p[0] += r, p[1] += g, p[2] += b;
  }

 private:
  float* sums_;
  int film_width_;
  TileRect rect_;
};

class Film {
 public:
  Film(int width, int height) : width_(width), height_(height), sums_(static_cast<size_t>(width) * height * 3) {}
  int width() const { return width_; }
  int height() const { return height_; }
  TileView view(TileRect rect) { return TileView(sums_.data(), width_, rect); }
  // The mean of `samples` samples a pixel. REQUIRES: samples >= 1 and no writer.
  Image resolve(int samples) const;

 private:
  int width_, height_;
  std::vector<float> sums_;
};

}  // namespace tilelight
