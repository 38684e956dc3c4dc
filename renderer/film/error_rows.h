// SPDX-License-Identifier: Apache-2.0
// The arithmetic of ErrorMap on rows of pixels that lie side by side: plain loops over short arrays, which a compiler
// turns into lanes. Linear and displayed light as in error_map.h. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "renderer/film/film.h"

namespace tilelight {

// By distance in octaves, neighbouring blocks are compared: of the shortest length, twice and four times that.
inline constexpr int kErrorLevels = 3;

// How many differences a pixel of n samples has at a level: pairs of whole blocks.
struct BlockPairs {
  explicit BlockPairs(uint32_t samples) : length(sample_block_length(samples - 1)), blocks(samples / length) {}
  uint32_t at(int level) const { return blocks >> (level + 1); }
  uint32_t total() const { return at(0) + at(1) + at(2); }
  size_t levels() const { return static_cast<size_t>(std::bit_width(blocks)) - 1; }  // that have any
  uint32_t length, blocks;
};

// What multiplies the squared half difference of two blocks of a level to give the variance of the whole mean, if
// doubling a block's samples multiplies its variance by `decay`.
std::array<double, kErrorLevels> to_whole(double decay, uint32_t samples);

// What measuring pixels needs to know of their number of samples, one or more.
struct ErrorRule {
  explicit ErrorRule(uint32_t samples_of_pixel);
  uint32_t samples;
  BlockPairs pairs;
  std::array<float, kErrorLevels> weights, half_block;
  float deviation2;  // of the mean, if samples were independent: over what weights make of differences
  // static_cast<float>(sqrt(v) / sqrt(deviation2 * v)), in double, for every v; if that is sure.
  std::optional<float> ratio;
};

// The channels of a run's row of pixels.
using ChannelRow = std::array<float, 3 * kRunPx>;

// What the pixels of a row are shown as, by channel: to ErrorMap's precision, and rounded to bytes in three planes.
void show_row(const float* mean, size_t channels, double exposure, ChannelRow& shown, std::array<uint8_t*, 3> bytes);

// Displayed variances of a row's means, as if an edge crossed each.
struct RowVariances {
  size_t count = 0;                                  // of channels whose samples differ; the others have none
  std::array<uint8_t, ChannelRow().size()> channel;  // which of the row's, rising
  std::array<float, ChannelRow().size()> variance;   // by them
  std::array<std::array<float, ChannelRow().size()>, kErrorLevels> levels;  // and what of it each level's blocks make
};
// planes: of the row's first channel. REQUIRES: two samples or more; shown: of this row, by show_row.
void measure_row(const SamplePlanes& planes, const float* mean, size_t channels, double exposure, const ErrorRule& rule,
                 const ChannelRow& shown, RowVariances& out);

// A row of shown bytes, with a pixel before it and one after it, as numbers; and their squares' sum by pixel.
struct ShownRow {
  std::array<std::array<float, kRunPx + 2>, 3> channel;
  std::array<float, kRunPx + 2> square;
};
// bytes: by channel, of the pixel before the row. Beyond the image's edges all are 0.
void load_shown(const std::array<const uint8_t*, 3>& bytes, size_t pixels, ShownRow& out);

// A row with the rows above and below it. own, shown: of these three; own: of their first pixels, with a pixel before
// and one after each row. Beyond the image's edges all are 0.
struct Neighbourhood {
  std::array<const float*, 3> own;
  std::array<const ShownRow*, 3> shown;
  std::array<float, kRunPx> count;   // by pixel: of the nine there are in the image
  std::array<float, kRunPx> unseen;  // by pixel: what it may have missed, of its contrast
};
// By pixel, the variance of its mean: scale times what its own samples and those of its neighbours tell, weighed, and
// what it may have missed of its contrast with them.
void spread_row(const Neighbourhood& around, size_t pixels, float scale, float* variances);

}  // namespace tilelight
