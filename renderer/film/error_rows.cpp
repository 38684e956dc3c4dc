// SPDX-License-Identifier: Apache-2.0
#include "renderer/film/error_rows.h"

#include <algorithm>
#include <cmath>

#include "renderer/base/elementary.h"
#include "renderer/film/error_map.h"
#include "renderer/film/tone.h"

namespace tilelight {
namespace {

constexpr float kIndependent = 3.0f;  // variance of independent samples over that of an edge, about
constexpr float kNeighbours = 0.5f;   // weight of the neighbours in a pixel's variance; calibrated, see README.md

// The sRGB curve by straight pieces: within 2e-5, and rising.
class Curve {
 public:
  Curve() {
    for (int i = 0; i <= kPieces; ++i)
      knots_[static_cast<size_t>(i)] = static_cast<float>(srgb_from_linear(static_cast<double>(i) / kPieces));
    knots_[kPieces + 1] = knots_[kPieces];
  }

  void operator()(const double* linear, size_t count, float* out) const {
    std::array<float, ChannelRow().size()> part;
    std::array<int, ChannelRow().size()> piece;
    for (size_t i = 0; i < count; ++i) {
      // A comparison that NaN fails: then it is black.
      const float at = linear[i] > 0.0 ? static_cast<float>(std::min(linear[i], 1.0)) * kPieces : 0.0f;
      piece[i] = static_cast<int>(at);
      part[i] = at - static_cast<float>(piece[i]);
    }
    for (size_t i = 0; i < count; ++i) {
      const float* knot = knots_.data() + piece[i];
      out[i] = knot[0] + part[i] * (knot[1] - knot[0]);
    }
  }

 private:
  static constexpr int kPieces = 4096;
  std::array<float, kPieces + 2> knots_;
};

const Curve& curve() {
  static const Curve the_curve;
  return the_curve;
}

// Squares of light have to stay in a float's range, however bright a scene is. So a channel's light is taken in units
// of a power of two, which changes no digit: near the display's white, and larger for what is far brighter.
using Units = std::array<float, ChannelRow().size()>;
void choose_units(const float* mean, size_t channels, double exposure, Units& units) {
  // Light that a float holds comes to no display beyond these by squares that overflow or vanish.
  constexpr int kMostOctaves = 90, kBlindingOctaves = 40;
  const double white = std::ldexp(1.0, std::clamp(std::ilogb(exposure), -kMostOctaves, kMostOctaves));
  const double blinding = std::ldexp(1.0, kBlindingOctaves) / white;
  for (size_t i = 0; i < channels; ++i)
    units[i] = static_cast<float>(mean[i] > blinding ? std::ldexp(1.0, kBlindingOctaves - std::ilogb(mean[i])) : white);
}

// By level, the sum of the squared half differences of the row's blocks, in units; and what variance of the
// mean they make if an edge crosses.
struct Differences {
  std::array<ChannelRow, kErrorLevels> levels;
  ChannelRow variance;
};

void find_differences(const SamplePlanes& planes, size_t channels, const ErrorRule& rule, const Units& units,
                      Differences& out) {
  std::array<ChannelRow, kSampleBlocks / 2> joined;  // two and two
  std::array<const float*, kSampleBlocks> blocks;
  std::copy(planes.begin(), planes.end(), blocks.begin());
  out.variance = {};
  for (size_t level = 0; level < rule.pairs.levels(); ++level) {
    float* const of_level = out.levels[level].data();
    std::fill_n(of_level, channels, 0.0f);
    for (size_t pair = 0; pair < rule.pairs.at(static_cast<int>(level)); ++pair) {
      const float *const one = blocks[2 * pair], *const other = blocks[2 * pair + 1];
      for (size_t i = 0; i < channels; ++i) {
        const float half = rule.half_block[level] * units[i] * (one[i] - other[i]);
        of_level[i] += half * half;
      }
      // Read before they are written over: they become the first of the next level's.
      for (size_t i = 0; i < channels; ++i) joined[pair][i] = one[i] + other[i];
    }
    for (size_t i = 0; i < channels; ++i) out.variance[i] += rule.weights[level] * of_level[i];
    std::transform(joined.begin(), joined.end(), blocks.begin(), [](const ChannelRow& row) { return row.data(); });
  }
}

}  // namespace

// Joining two blocks takes away 1 - decay of their variance. The whole is made of aligned blocks by the binary digits
// of its samples, and has the sum of their errors: 40 samples are 32 and 8, and the 8 spoil what the 32 have gained.
std::array<double, kErrorLevels> to_whole(double decay, uint32_t samples) {
  const BlockPairs pairs(samples);
  std::array<double, kErrorLevels> out{};
  for (int level = 0; level < kErrorLevels; ++level) {
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

ErrorRule::ErrorRule(uint32_t samples_of_pixel) : samples(samples_of_pixel), pairs(samples) {
  const auto exact = to_whole(kEdgeDecay, samples);
  for (size_t level = 0; level < weights.size(); ++level) {
    weights[level] = static_cast<float>(exact[level]);
    half_block[level] = 0.5f / static_cast<float>(pairs.length << level);
  }
  deviation2 = samples < 2 ? 0.0f : kIndependent / static_cast<float>(pairs.total());
  // Two roots and a quotient, each rounded, are within nine parts in 2^53 of it.
  const double exact_ratio = 1.0 / std::sqrt(double{deviation2});
  const float below = static_cast<float>(exact_ratio * (1.0 - 1e-15)),
              above = static_cast<float>(exact_ratio * (1.0 + 1e-15));
  if (below == above) ratio = below;
}

void show_row(const float* mean, size_t channels, double exposure, ChannelRow& shown, std::array<uint8_t*, 3> bytes) {
  std::array<double, ChannelRow().size()> exposed;
  for (size_t i = 0; i < channels; ++i) exposed[i] = exposure * double{mean[i]};
  curve()(exposed.data(), channels, shown.data());
  for (size_t pixel = 0; pixel < channels / 3; ++pixel) {
    for (size_t channel = 0; channel < 3; ++channel)
      bytes[channel][pixel] = static_cast<uint8_t>(static_cast<int>(255.0f * shown[3 * pixel + channel] + 0.5f));
  }
}

// From linear to displayed by how far the curve goes over the mean's uncertainty, if samples were independent: near
// black it goes down much farther than up.
void measure_row(const SamplePlanes& planes, const float* mean, size_t channels, double exposure, const ErrorRule& rule,
                 const ChannelRow& shown, RowVariances& out) {
  Units units;
  choose_units(mean, channels, exposure, units);
  Differences differences;
  find_differences(planes, channels, rule, units, differences);
  out.count = 0;
  for (size_t i = 0; i < channels; ++i) {
    out.channel[out.count] = static_cast<uint8_t>(i);
    out.count += differences.variance[i] > 0.0f;
  }
  const size_t count = out.count;
  std::array<double, ChannelRow().size()> linear, shown_unit, reach, least, down, up;
  std::array<float, ChannelRow().size()> variance, middle, low, high;
  for (size_t k = 0; k < count; ++k) {
    const size_t i = out.channel[k];
    variance[k] = differences.variance[i];
    linear[k] = double{units[i]} * mean[i];
    shown_unit[k] = exposure / units[i];
    middle[k] = shown[i];
  }
  const double deviation2 = rule.deviation2;
  for (size_t k = 0; k < count; ++k) {
    least[k] = 0x1p-12 / shown_unit[k];
    reach[k] = std::max(std::sqrt(deviation2 * variance[k]), least[k]);
    down[k] = shown_unit[k] * (linear[k] - reach[k]);
    up[k] = shown_unit[k] * (linear[k] + reach[k]);
  }
  curve()(down.data(), count, low.data());
  curve()(up.data(), count, high.data());
  std::array<float, ChannelRow().size()> ratio;  // of the deviation to the reach
  std::fill_n(ratio.begin(), count, rule.ratio.value_or(0.0f));
  for (size_t k = 0; k < count; ++k) {
    const bool is_known = rule.ratio && reach[k] > least[k];
    if (!is_known) ratio[k] = static_cast<float>(std::sqrt(double{variance[k]}) / reach[k]);
  }
  for (size_t k = 0; k < count; ++k) {
    const float deviation = ratio[k] * std::max(middle[k] - low[k], high[k] - middle[k]);
    out.variance[k] = deviation * deviation;
  }
  for (size_t level = 0; level < rule.pairs.levels(); ++level) {
    for (size_t k = 0; k < count; ++k) {
      const float of_level = differences.levels[level][out.channel[k]];
      out.levels[level][k] = out.variance[k] * (of_level / variance[k]);
    }
  }
}

void load_shown(const std::array<const uint8_t*, 3>& bytes, size_t pixels, ShownRow& out) {
  for (size_t i = 0; i < pixels + 2; ++i) {
    const float r = bytes[0][i], g = bytes[1][i], b = bytes[2][i];
    out.channel[0][i] = r, out.channel[1][i] = g, out.channel[2][i] = b;
    out.square[i] = r * r + g * g + b * b;
  }
}

namespace {

// By pixel, the sum of the squared differences to its neighbours, over channels. With the nine values v around h, the
// sum of (v - h)^2 is that of v^2 less 2 h times that of v, and h^2 for each of them. All are whole numbers that a
// float holds exactly.
void add_contrasts(const std::array<const ShownRow*, 3>& rows, const float* count, size_t pixels, float* out) {
  std::array<float, kRunPx + 2> column;
  const auto add_up = [&](const auto& row_of) {
    const float *const above = row_of(*rows[0]), *const here = row_of(*rows[1]), *const below = row_of(*rows[2]);
    for (size_t i = 0; i < pixels + 2; ++i) column[i] = above[i] + here[i] + below[i];
    return here;
  };
  const float* const square = add_up([](const ShownRow& row) { return row.square.data(); });
  for (size_t i = 0; i < pixels; ++i) out[i] = (column[i] + column[i + 1] + column[i + 2]) + count[i] * square[i + 1];
  for (size_t channel = 0; channel < 3; ++channel) {
    const float* const here = add_up([channel](const ShownRow& row) { return row.channel[channel].data(); });
    for (size_t i = 0; i < pixels; ++i) out[i] -= 2.0f * here[i + 1] * (column[i] + column[i + 1] + column[i + 2]);
  }
}

}  // namespace

void spread_row(const Neighbourhood& around, size_t pixels, float scale, float* variances) {
  std::array<float, kRunPx> contrast;
  add_contrasts(around.shown, around.count.data(), pixels, contrast.data());
  // Each from the pixel before the first on.
  const float *const above = around.own[0] - 1, *const here = around.own[1] - 1, *const below = around.own[2] - 1;
  std::array<float, kRunPx> sums;
  for (size_t i = 0; i < pixels; ++i) {
    sums[i] = above[i] + above[i + 1] + above[i + 2] + here[i] + here[i + 1] + here[i + 2] + below[i] + below[i + 1] +
              below[i + 2];
  }
  for (size_t i = 0; i < pixels; ++i) {
    // The only pixel of an image has no neighbours, and no contrast.
    const float others = around.count[i] - 1.0f, own = here[i + 1];
    const float neighbours = others > 0.0f ? (sums[i] - own) / others : own;
    const float mean_contrast = others > 0.0f ? contrast[i] / (3.0f * 255.0f * 255.0f * others) : 0.0f;
    const float seen = scale * (own + kNeighbours * (neighbours - own));
    variances[i] = seen + around.unseen[i] * mean_contrast;
  }
}

}  // namespace tilelight
