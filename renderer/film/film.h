// SPDX-License-Identifier: Apache-2.0
// Film: the samples of every pixel, linear RGB, in up to eight aligned blocks of each pixel's sequence. Their sum is
// the picture, their differences tell its error (error_map.h). Work items write disjoint TileViews from many
// threads without locks. What a pixel holds is a function of the samples it was given, in the order of their indices:
// any split of the same total gives the same bytes.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <utility>
#include <vector>

namespace tilelight {

struct TileRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // pixels, half open
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  int64_t pixel_count() const { return static_cast<int64_t>(width()) * height(); }
};

// The rectangles of a grid of tiles with edge tile_px over the image, row by row. Pure.
int tile_count(int width, int height, int tile_px);
TileRect tile_rect(int index, int width, int height, int tile_px);

// Pixels take samples by cells: squares of 4 by 4, anchored at the image's first pixel and cut at its last.
inline constexpr int kCellPx = 4;
inline constexpr int kRunPx = 8 * kCellPx;  // of cells that are worked on together, at most

// visit(part of a cell, a TileRect) for every cell that meets the rectangle, row by row.
template <class Visit>
void for_each_cell(const TileRect& rect, const Visit& visit) {
  constexpr auto next = [](int v) { return v / kCellPx * kCellPx + kCellPx; };
  for (int top = rect.y0; top < rect.y1; top = next(top)) {
    for (int left = rect.x0; left < rect.x1; left = next(left))
      visit(TileRect{left, top, std::min(next(left), rect.x1), std::min(next(top), rect.y1)});
  }
}

// visit(x, y) for every pixel, row by row.
template <class Visit>
void for_each_pixel(const TileRect& rect, const Visit& visit) {
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x) visit(x, y);
}

// A linear image: width * height * 3 floats, RGB, row by row from the top.
struct Image {
  int width = 0, height = 0;  // pixels
  std::vector<float> rgb;
};

// A pixel's sequence in aligned blocks of equal length: as short as eight of them can hold it. Pure.
inline constexpr uint32_t kSampleBlocks = 8;
// Length of the blocks once sample `index` (from 0) is there: 1, 1, ... 1, then 2 from index 8 on, 4 from 16 on, ...
constexpr uint32_t sample_block_length(uint32_t index) { return std::bit_ceil(index / kSampleBlocks + 1); }

// fn(std::integral_constant<int, count>), so that loops over blocks are unrolled. REQUIRES: count <= kSampleBlocks.
template <class Fn>
void with_block_count(uint32_t count, const Fn& fn) {
  [&]<int... kCounts>(std::integer_sequence<int, kCounts...>) {
    ((static_cast<uint32_t>(kCounts) == count ? fn(std::integral_constant<int, kCounts>()) : void()), ...);
  }
  (std::make_integer_sequence<int, kSampleBlocks + 1>());
}

// By block, the first float of its plane: the sums of one block in every pixel, laid out like an Image.
using SamplePlanes = std::array<float*, kSampleBlocks>;

// A work item's own window on the film. Threads: one at a time per pixel.
class TileView {
 public:
  TileView(SamplePlanes planes, int film_width) : planes_(planes), film_width_(film_width) {}
  // Sample `index` of `count` pixels of a row, the first of them (x, y); rgb: three floats a pixel. REQUIRES: in the
  // window, film coordinates; every sample before `index` is there.
  void add(int x, int y, int count, uint32_t index, const float* rgb) {
    const size_t at = (static_cast<size_t>(y) * film_width_ + x) * 3, floats = 3 * static_cast<size_t>(count);
    if (index >= kSampleBlocks && (index & (index - 1)) == 0) join_blocks(at, floats);
    const int shift = std::countr_zero(sample_block_length(index));
    float* const p = planes_[index >> shift] + at;
    // What was there before a block's first sample is of no account, and was never written by anybody.
    const bool is_first = index == index >> shift << shift;
    for (size_t i = 0; i < floats; ++i) p[i] = (is_first ? 0.0f : p[i]) + rgb[i];
  }

 private:
  // Eight full blocks become four of twice the length.
  void join_blocks(size_t at, size_t floats) {
    for (size_t i = 0; i < kSampleBlocks / 2; ++i) {
      for (size_t f = at; f < at + floats; ++f) planes_[i][f] = planes_[2 * i][f] + planes_[2 * i + 1][f];
    }
  }

  SamplePlanes planes_;
  int film_width_;
};

class Film {
 public:
  Film(int width, int height);
  int width() const { return width_; }
  int height() const { return height_; }
  // Room for that many samples in every pixel. Nobody has written there: of a pixel only the blocks of its samples mean
  // something.
  void grow(uint32_t samples);
  // So many black samples in every pixel.
  void fill_black(uint32_t samples);
  TileView view() { return TileView(planes(), width_); }
  // By cell, row by row: samples in each of its pixels. Set by the owner, after whole passes.
  size_t cell_at(int x, int y) const {
    return static_cast<size_t>(y / kCellPx) * ((width_ + kCellPx - 1) / kCellPx) + x / kCellPx;
  }
  std::vector<uint32_t>& samples() { return samples_; }
  const std::vector<uint32_t>& samples() const { return samples_; }
  double mean_samples() const;  // of all pixels
  SamplePlanes planes() const;  // null beyond what has grown
  int64_t bytes() const;        // that the planes may take
  // Takes over the samples of a part from a film of the same size; their numbers are the owner's to take over. Parts
  // that share no cell may be done by many threads. REQUIRES: grown for them; no writer there.
  void copy(const TileRect& part, const Film& from);
  // Writes the mean of every pixel's samples into the image, black where there are none. Parts that share no cell may
  // be done by many threads. REQUIRES: no writer there; an image of the film's size.
  void resolve(const TileRect& part, Image& image) const;
  // visit(rectangle, samples of each of its pixels) for all of a part: neighbours in a row of cells go together while
  // they have as many samples, up to kRunPx pixels. Loops over a row of a run are long enough for lanes.
  template <class Visit>
  void for_each_run(const TileRect& part, const Visit& visit) const {
    for_each_cell({part.x0, part.y0, part.x0 + 1, part.y1}, [&](const TileRect& first) {
      TileRect run{part.x0, first.y0, part.x0, first.y1};
      while (run.x1 < part.x1) {
        const uint32_t count = samples_[cell_at(run.x1, run.y0)];
        run.x0 = run.x1;
        do {
          run.x1 = std::min(run.x1 / kCellPx * kCellPx + kCellPx, part.x1);
        } while (run.x1 < part.x1 && run.x1 + kCellPx <= run.x0 + kRunPx && samples_[cell_at(run.x1, run.y0)] == count);
        visit(run, count);
      }
    });
  }

 private:
  struct Free {
    void operator()(float* p) const { std::free(p); }
  };

  int width_, height_;
  std::array<std::unique_ptr<float[], Free>, kSampleBlocks> planes_;
  std::vector<uint32_t> samples_;
};

}  // namespace tilelight
