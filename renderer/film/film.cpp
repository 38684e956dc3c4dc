// SPDX-License-Identifier: Apache-2.0
#include "renderer/film/film.h"

#include <new>

namespace tilelight {
namespace {

uint32_t blocks_in_use(uint32_t samples) {
  return samples == 0 ? 0 : (samples - 1) / sample_block_length(samples - 1) + 1;
}

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

Film::Film(int width, int height)
    : width_(width), height_(height), samples_(static_cast<size_t>(tile_count(width, height, kCellPx))) {}

void Film::grow(uint32_t samples) {
  const size_t floats = static_cast<size_t>(width_) * height_ * 3;
  for (uint32_t i = 0; i < std::min(samples, kSampleBlocks); ++i) {
    if (planes_[i]) continue;
    // As it comes: zeros that one thread writes here would keep all the others waiting.
    planes_[i].reset(static_cast<float*>(std::malloc(floats * sizeof(float))));
    if (!planes_[i]) throw std::bad_alloc();
  }
}

void Film::fill_black(uint32_t samples) {
  grow(samples);
  const size_t floats = static_cast<size_t>(width_) * height_ * 3;
  for (uint32_t block = 0; block < blocks_in_use(samples); ++block) std::fill_n(planes_[block].get(), floats, 0.0f);
  std::fill(samples_.begin(), samples_.end(), samples);
}

double Film::mean_samples() const {
  uint64_t sum = 0;
  for_each_cell({0, 0, width_, height_}, [&](const TileRect& cell) {
    sum += samples_[cell_at(cell.x0, cell.y0)] * static_cast<uint64_t>(cell.pixel_count());
  });
  return static_cast<double>(sum) / (static_cast<double>(width_) * height_);
}

SamplePlanes Film::planes() const {
  SamplePlanes out;
  std::transform(planes_.begin(), planes_.end(), out.begin(), [](const auto& plane) { return plane.get(); });
  return out;
}

int64_t Film::bytes() const {
  const auto grown = std::count_if(planes_.begin(), planes_.end(), [](const auto& plane) { return plane != nullptr; });
  return grown * int64_t{width_} * height_ * 3 * static_cast<int64_t>(sizeof(float));
}

void Film::copy(const TileRect& part, const Film& from) {
  for_each_cell(part, [&](const TileRect& cell) {
    const uint32_t blocks = blocks_in_use(from.samples_[cell_at(cell.x0, cell.y0)]);
    for (uint32_t block = 0; block < blocks; ++block) {
      for (int y = cell.y0; y < cell.y1; ++y) {
        const size_t at = (static_cast<size_t>(y) * width_ + cell.x0) * 3;
        std::copy_n(from.planes_[block].get() + at, 3 * cell.width(), planes_[block].get() + at);
      }
    }
  });
}

void Film::resolve(const TileRect& part, Image& image) const {
  const SamplePlanes from = planes();
  for_each_run(part, [&](const TileRect& run, uint32_t count) {
    const float n = static_cast<float>(std::max(1u, count));
    with_block_count(blocks_in_use(count), [&](auto blocks) {
      for (int y = run.y0; y < run.y1; ++y) {
        const size_t first = (static_cast<size_t>(y) * width_ + run.x0) * 3;
        float* const mean = image.rgb.data() + first;
        for (size_t i = 0; i < 3 * static_cast<size_t>(run.width()); ++i) {
          std::array<float, kSampleBlocks> sums{};
          for (size_t block = 0; block < size_t{blocks}; ++block) sums[block] = from[block][first + i];
          const float sum = ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
          mean[i] = sum / n;  // not a product with 1/n: that would be rounded twice
        }
      }
    });
  });
}

}  // namespace tilelight
