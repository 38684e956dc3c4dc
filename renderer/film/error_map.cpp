// SPDX-License-Identifier: Apache-2.0
#include "renderer/film/error_map.h"

#include <cmath>
#include <optional>

#include "renderer/base/elementary.h"
#include "renderer/film/tone.h"

namespace tilelight {
namespace {

constexpr double kNormal95 = 1.96;
constexpr float kConverged = static_cast<float>(2.0 / 255.0 / kNormal95);

constexpr float kIndependent = 3.0f;  // variance of independent samples over that of an edge, about

// Calibration, published in README.md.
constexpr double kCalibration = 1.05;  // of the picture's rmse
constexpr double kSystematic = 0.05;   // relative standard deviation of rmse over scenes, after it
constexpr float kNeighbours = 0.5f;    // weight of the neighbours in a pixel's variance
constexpr float kUnseen = 1.0f;        // what a pixel may have missed: so much of its contrast, over n

// The sRGB curve by straight pieces: within 2e-5, and rising.
class Curve {
 public:
  Curve() {
    for (int i = 0; i <= kPieces; ++i)
      knots_[static_cast<size_t>(i)] = static_cast<float>(srgb_from_linear(static_cast<double>(i) / kPieces));
    knots_[kPieces + 1] = knots_[kPieces];
  }
  float operator()(double linear) const {
    // A comparison that NaN fails: then it is black.
    const float at = linear > 0.0 ? static_cast<float>(std::min(linear, 1.0)) * kPieces : 0.0f;
    const int piece = static_cast<int>(at);
    const float* knot = knots_.data() + piece;
    return knot[0] + (at - static_cast<float>(piece)) * (knot[1] - knot[0]);
  }
  static constexpr int kPieces = 4096;

 private:
  std::array<float, kPieces + 2> knots_;
};

// How many differences a pixel of n samples has at a level: pairs of whole blocks.
struct Pairs {
  explicit Pairs(uint32_t samples) : length(sample_block_length(samples - 1)), blocks(samples / length) {}
  uint32_t at(int level) const { return blocks >> (level + 1); }
  uint32_t total() const { return at(0) + at(1) + at(2); }
  uint32_t length, blocks;
};

// What multiplies the squared half difference of two blocks of a level to give the variance of the whole mean, if
// doubling a block's samples multiplies its variance by `decay`: joining the two takes away 1 - decay of it. The whole
// is made of aligned blocks by the binary digits of its samples, and has the sum of their errors: 40 samples are 32 and
// 8, and the 8 spoil what the 32 have gained.
std::array<double, 3> to_whole(double decay, uint32_t samples) {
  const Pairs pairs(samples);
  std::array<double, 3> out{};
  for (int level = 0; level < 3; ++level) {
    const double octaves_below = std::countr_zero(pairs.length) + level;
    for (uint32_t rest = samples; rest != 0; rest &= rest - 1) {
      const double share = static_cast<double>(rest & (~rest + 1)) / samples;
      const double octaves = std::countr_zero(rest) - octaves_below;
      out[static_cast<size_t>(level)] += share * share * elementary::exp2(elementary::log2(decay) * octaves);
    }
    out[static_cast<size_t>(level)] /= 1.0 - decay;
  }
  return out;
}

struct Weights {
  uint32_t samples;
  std::array<double, 3> edge, decayed;
};

// What measuring a cell needs to know of its number of samples.
struct CellRule {
  explicit CellRule(uint32_t samples_of_cell)
      : samples(samples_of_cell), pairs(samples), blocks((samples - 1) / pairs.length + 1) {
    const auto exact = to_whole(kEdgeDecay, samples);
    for (size_t level = 0; level < weights.size(); ++level) {
      weights[level] = static_cast<float>(exact[level]);
      half_block[level] = 0.5f / static_cast<float>(pairs.length << level);
    }
    deviation2 = samples < 2 ? 0.0f : kIndependent / static_cast<float>(pairs.total());
  }
  uint32_t samples;
  Pairs pairs;
  uint32_t blocks;
  std::array<float, 3> weights, half_block;
  float deviation2;  // of the mean, if samples were independent: over what weights make of differences
};

// The channels of a cell's row; beyond the image's edge 0. Loops over all of it run in lanes.
constexpr size_t kRow = 3 * kCellPx;
using Row = std::array<float, kRow>;

// By level, the sum of the squared half differences of the row's blocks, linear; and what variance of the mean they
// make if an edge crosses.
std::array<Row, 3> differences(const SamplePlanes& planes, size_t first, size_t count, const CellRule& rule,
                               Row& variance) {
  std::array<Row, kSampleBlocks> sums{};
  for (uint32_t block = 0; block < rule.blocks; ++block) std::copy_n(planes[block] + first, count, sums[block].begin());
  std::array<Row, 3> out{};
  variance = {};
  for (size_t level = 0; level < out.size(); ++level) {
    for (uint32_t pair = 0; pair < rule.pairs.at(static_cast<int>(level)); ++pair) {
      for (size_t i = 0; i < kRow; ++i) {
        const float half = rule.half_block[level] * (sums[2 * pair][i] - sums[2 * pair + 1][i]);
        out[level][i] += half * half;
      }
    }
    for (uint32_t pair = 0; pair < kSampleBlocks >> (level + 1); ++pair)
      for (size_t i = 0; i < kRow; ++i) sums[pair][i] = sums[2 * pair][i] + sums[2 * pair + 1][i];
    for (size_t i = 0; i < kRow; ++i) variance[i] += rule.weights[level] * out[level][i];
  }
  return out;
}

}  // namespace

ErrorMap::ErrorMap(int width, int height, double exposure_stops)
    : width_(width),
      height_(height),
      exposure_(elementary::exp2(exposure_stops)),
      own_(static_cast<size_t>(width) * height),
      shown_(own_.size() * 3),
      levels_(static_cast<size_t>(tile_count(width, height, kCellPx))),
      variances_(own_.size()),
      cell_variances_(levels_.size()) {}

void ErrorMap::measure(const Film& film, const Image& image, const TileRect& part) {
  static const Curve curve;
  const SamplePlanes planes = film.planes();
  std::optional<CellRule> rule;
  for_each_cell(part, [&](const TileRect& cell) {
    const size_t at = film.cell_at(cell.x0, cell.y0);
    const uint32_t samples = film.samples()[at];
    if (samples == 0) return;
    if (!rule || rule->samples != samples) rule.emplace(samples);
    std::array<double, kLevels> sums{};
    for (int y = cell.y0; y < cell.y1; ++y) {
      const size_t first = (static_cast<size_t>(y) * width_ + cell.x0) * 3;
      const size_t count = static_cast<size_t>(cell.x1 - cell.x0) * 3;
      Row variance;
      std::array<Row, kLevels> levels = differences(planes, first, count, *rule, variance);
      Row own{};
      for (size_t i = 0; i < count; ++i) {
        const double mean = image.rgb[first + i];
        const float middle = curve(exposure_ * mean);
        shown_[first + i] = static_cast<uint8_t>(255.0f * middle + 0.5f);
        if (!(variance[i] > 0.0f)) continue;
        // From linear to displayed by how far the curve goes over the mean's uncertainty, if samples were independent:
        // near black it goes down much farther than up.
        const double reach = std::max(std::sqrt(double{rule->deviation2} * variance[i]), 0x1p-12 / exposure_);
        const float change =
            std::max(middle - curve(exposure_ * (mean - reach)), curve(exposure_ * (mean + reach)) - middle);
        const float deviation = change * static_cast<float>(std::sqrt(double{variance[i]}) / reach);
        own[i] = deviation * deviation;
        for (size_t level = 0; level < kLevels; ++level) sums[level] += own[i] * (levels[level][i] / variance[i]);
      }
      for (int x = cell.x0; x < cell.x1; ++x) {
        const float* pixel = &own[static_cast<size_t>(x - cell.x0) * 3];
        own_[static_cast<size_t>(y) * width_ + x] =
            samples < 2 ? 0.0f : (pixel[0] + pixel[1] + pixel[2]) / static_cast<float>(3 * rule->pairs.total());
      }
    }
    std::transform(sums.begin(), sums.end(), levels_[at].begin(), [](double sum) { return static_cast<float>(sum); });
  });
}

void ErrorMap::pool(const Film& film) {
  const std::vector<uint32_t>& samples = film.samples();
  // Of each level that has one above: the mean squared difference there, and on the level above.
  double shorter = 0.0, longer = 0.0;
  is_known_ = true;
  for (size_t i = 0; i < levels_.size(); ++i) {
    if (samples[i] < 2) {
      is_known_ = false;
      continue;
    }
    const Pairs pairs(samples[i]);
    for (int level = 0; level + 1 < kLevels && pairs.at(level + 1) > 0; ++level) {
      shorter += static_cast<double>(levels_[i][static_cast<size_t>(level)]) / pairs.at(level);
      longer += static_cast<double>(levels_[i][static_cast<size_t>(level) + 1]) / pairs.at(level + 1);
    }
  }
  // Between what is smooth and what is random.
  decay_ = shorter > 0.0 ? std::clamp(longer / shorter, 0.0625, 0.5) : kEdgeDecay;
  double as_edge = 0.0, as_decayed = 0.0;
  decayed_.assign(levels_.size(), 0.0f);
  Weights weights{0, {}, {}};
  for (size_t i = 0; i < levels_.size(); ++i) {
    if (samples[i] < 2) continue;
    if (samples[i] != weights.samples)
      weights = {samples[i], to_whole(kEdgeDecay, samples[i]), to_whole(decay_, samples[i])};
    const double pairs = 3.0 * Pairs(samples[i]).total();
    double sum = 0.0;
    for (size_t level = 0; level < kLevels; ++level) {
      as_edge += levels_[i][level] * weights.edge[level] / pairs;
      sum += levels_[i][level] * weights.decayed[level] / pairs;
    }
    as_decayed += sum;
    decayed_[i] = static_cast<float>(sum);
  }
  scale_ = as_edge > 0.0 ? static_cast<float>(kCalibration * kCalibration * as_decayed / as_edge) : 1.0f;
  look_back(film);
}

// While all pixels had as many samples, the error of the picture was told without prejudice. Then samples went where
// it had shown. If there it proves much smaller than it had seemed, it was a chance that had shown a little of what
// is everywhere (as a wire shows in one pixel of a hundred), and most of it is where it has not shown yet.
void ErrorMap::look_back(const Film& film) {
  const std::vector<uint32_t>& samples = film.samples();
  const auto [least, most] = std::minmax_element(samples.begin(), samples.end());
  unseen_ = 0.0;
  if (*least == *most) {
    first_samples_ = *least;
    first_variances_ = decayed_;
    return;
  }
  double seemed = 0.0, proved = 0.0, open = 0.0;
  for (size_t i = 0; i < samples.size(); ++i) {
    open += static_cast<double>(first_samples_) / samples[i];
    if (samples[i] <= first_samples_) continue;
    const double octaves = elementary::log2(static_cast<double>(samples[i]) / first_samples_);
    seemed += first_variances_[i];
    proved += decayed_[i] * elementary::exp2(-elementary::log2(decay_) * octaves);
  }
  constexpr double kMuch = 2.0;  // less may be chance, or another decay
  if (seemed > kMuch * proved)
    unseen_ = kCalibration * kCalibration * (seemed - proved) * open / static_cast<double>(samples.size());
}

std::vector<double> ErrorMap::own_cell_variances() const {
  std::vector<double> out(decayed_.size());
  std::transform(decayed_.begin(), decayed_.end(), out.begin(),
                 [](float v) { return kCalibration * kCalibration * v; });
  return out;
}

// The mean square difference to the neighbours, displayed.
float ErrorMap::contrast(int x, int y) const {
  const uint8_t* here = &shown_[(static_cast<size_t>(y) * width_ + x) * 3];
  int sum = 0, count = 0;
  for (int v = std::max(0, y - 1); v <= std::min(height_ - 1, y + 1); ++v) {
    for (int u = std::max(0, x - 1); u <= std::min(width_ - 1, x + 1); ++u) {
      const uint8_t* there = &shown_[(static_cast<size_t>(v) * width_ + u) * 3];
      for (int c = 0; c < 3; ++c) sum += (there[c] - here[c]) * (there[c] - here[c]);
      ++count;
    }
  }
  return count == 1 ? 0.0f : static_cast<float>(sum) / (3.0f * 255.0f * 255.0f * static_cast<float>(count - 1));
}

void ErrorMap::spread(const Film& film, const TileRect& part) {
  for_each_cell(part, [&](const TileRect& cell) {
    const size_t at = film.cell_at(cell.x0, cell.y0);
    const float n = static_cast<float>(std::max(1u, film.samples()[at]));
    float sum = 0.0f;
    for_each_pixel(cell, [&](int x, int y) {
      float around = 0.0f;
      int count = -1;
      for (int v = std::max(0, y - 1); v <= std::min(height_ - 1, y + 1); ++v) {
        for (int u = std::max(0, x - 1); u <= std::min(width_ - 1, x + 1); ++u, ++count)
          around += own_[static_cast<size_t>(v) * width_ + u];
      }
      const size_t pixel = static_cast<size_t>(y) * width_ + x;
      const float own = own_[pixel];
      const float neighbours = count > 0 ? (around - own) / static_cast<float>(count) : own;
      const float seen = scale_ * (own + kNeighbours * (neighbours - own));
      const float unseen = kUnseen / n;
      variances_[pixel] = seen + unseen * unseen * contrast(x, y);
      sum += variances_[pixel];
    });
    cell_variances_[at] = sum + static_cast<float>(unseen_ / static_cast<double>(levels_.size()));
  });
}

ErrorSummary ErrorMap::summary() const {
  ErrorSummary out;
  out.is_known = is_known_;
  if (!is_known_) return out;
  double sum = unseen_, squares = 0.0;
  float most = 0.0f;
  std::array<uint32_t, 1 << 13> counts{};  // by the upper bits of the variance: steps of 1/16 octave
  constexpr int kShift = 32 - 13;
  for (size_t i = 0; i < own_.size(); ++i) {
    const double own = static_cast<double>(own_[i]) * scale_;
    sum += own;
    squares += own * own;
    most = std::max(most, variances_[i]);
    out.unconverged += variances_[i] > kConverged * kConverged;
    ++counts[std::bit_cast<uint32_t>(variances_[i]) >> kShift];
  }
  const double pixels = static_cast<double>(own_.size());
  out.rmse = std::sqrt(sum / pixels);
  // Pixels are scrambled apart, so their errors are independent; an estimate from seven differences is good to its
  // half.
  const double chance = sum > 0.0 ? squares / (sum * sum) : 0.0;
  const double reach = kNormal95 * std::sqrt(kSystematic * kSystematic + chance);
  out.low = out.rmse * std::max(0.0, 1.0 - reach);
  out.high = out.rmse * (1.0 + reach);
  uint64_t above = 0;
  uint32_t bucket = static_cast<uint32_t>(counts.size());
  while (bucket > 0 && (above += counts[--bucket]) <= own_.size() / 100) continue;
  const float edge = std::min(most, std::bit_cast<float>((bucket + 1) << kShift));
  out.p99 = kNormal95 * std::sqrt(edge);
  out.most = kNormal95 * std::sqrt(most);
  return out;
}

std::vector<float> ErrorMap::bounds() const {
  std::vector<float> out(variances_.size());
  std::transform(variances_.begin(), variances_.end(), out.begin(),
                 [](float variance) { return static_cast<float>(kNormal95) * std::sqrt(variance); });
  return out;
}

}  // namespace tilelight
