// SPDX-License-Identifier: Apache-2.0
#include "renderer/film/error_map.h"

#include <cmath>

#include "renderer/base/elementary.h"
#include "renderer/film/error_rows.h"

namespace tilelight {
namespace {

constexpr double kNormal95 = 1.96;
constexpr float kConverged = static_cast<float>(2.0 / 255.0 / kNormal95);

// Calibration, published in README.md.
constexpr double kCalibration = 1.05;  // of the picture's rmse
constexpr double kSystematic = 0.05;   // relative standard deviation of rmse over scenes, after it
constexpr float kUnseen = 1.0f;        // what a pixel may have missed: so much of its contrast, over n

// What follows from a number of samples, worked out once for each that there is: there are few, and cells of equal
// numbers lie together.
template <class Facts>
class BySamples {
 public:
  template <class Make>
  const Facts& get(uint32_t samples, const Make& make) {
    if (last_ < known_.size() && known_[last_].first == samples) return known_[last_].second;
    const auto is_it = [samples](const auto& one) { return one.first == samples; };
    last_ = static_cast<size_t>(std::find_if(known_.begin(), known_.end(), is_it) - known_.begin());
    if (last_ == known_.size()) known_.emplace_back(samples, make());
    return known_[last_].second;
  }

 private:
  std::vector<std::pair<uint32_t, Facts>> known_;
  size_t last_ = 0;
};

// What pooling cells needs to know of their number of samples.
struct PoolRule {
  PoolRule(uint32_t samples, double decay)
      : pairs(samples), edge(to_whole(kEdgeDecay, samples)), decayed(to_whole(decay, samples)) {}
  BlockPairs pairs;
  std::array<double, kErrorLevels> edge, decayed;
};

}  // namespace

ErrorMap::ErrorMap(int width, int height, double exposure_stops)
    : width_(width),
      height_(height),
      stride_(static_cast<size_t>(width) + 2),
      exposure_(elementary::exp2(exposure_stops)),
      own_(stride_ * (static_cast<size_t>(height) + 2)),
      shown_(own_.size() * 3),
      levels_(static_cast<size_t>(tile_count(width, height, kCellPx))),
      variances_(static_cast<size_t>(width) * height),
      cell_variances_(levels_.size()) {}

void ErrorMap::measure(const Film& film, const Image& image, const TileRect& part) {
  BySamples<ErrorRule> rules;
  film.for_each_run(part, [&](const TileRect& run, uint32_t samples) {
    if (samples == 0) return;
    measure_run(film, image, run, rules.get(samples, [samples] { return ErrorRule(samples); }));
  });
}

void ErrorMap::measure_run(const Film& film, const Image& image, const TileRect& run, const ErrorRule& rule) {
  const size_t pixels = static_cast<size_t>(run.width()), channels = 3 * pixels;
  const float of_pixel = static_cast<float>(3 * rule.pairs.total());
  const size_t levels = std::min<size_t>(rule.pairs.levels(), kErrorLevels);  // never more; so the compiler knows
  std::array<std::array<double, kErrorLevels>, kRunPx / kCellPx> sums{};      // by cell
  for (int y = run.y0; y < run.y1; ++y) {
    const size_t first = (static_cast<size_t>(y) * width_ + run.x0) * 3;
    ChannelRow shown;
    uint8_t* const bytes = shown_.data() + at(run.x0, y);
    show_row(&image.rgb[first], channels, exposure_, shown, {bytes, bytes + own_.size(), bytes + 2 * own_.size()});
    if (rule.samples < 2) continue;
    SamplePlanes planes = film.planes();
    for (size_t block = 0; block < rule.pairs.blocks; ++block) planes[block] += first;
    RowVariances row;
    measure_row(planes, &image.rgb[first], channels, exposure_, rule, shown, row);
    ChannelRow own{};
    for (size_t k = 0; k < row.count; ++k) {
      const size_t channel = row.channel[k];
      own[channel] = row.variance[k];
      for (size_t level = 0; level < levels; ++level) sums[channel / (3 * kCellPx)][level] += row.levels[level][k];
    }
    float* const out = &own_[at(run.x0, y)];
    for (size_t i = 0; i < pixels; ++i) out[i] = (own[3 * i] + own[3 * i + 1] + own[3 * i + 2]) / of_pixel;
  }
  const size_t cell = film.cell_at(run.x0, run.y0);
  for (size_t i = 0; i * kCellPx < pixels; ++i) {
    std::transform(sums[i].begin(), sums[i].end(), levels_[cell + i].begin(),
                   [](double sum) { return static_cast<float>(sum); });
  }
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
    const BlockPairs pairs(samples[i]);
    for (int level = 0; level + 1 < kErrorLevels && pairs.at(level + 1) > 0; ++level) {
      shorter += static_cast<double>(levels_[i][static_cast<size_t>(level)]) / pairs.at(level);
      longer += static_cast<double>(levels_[i][static_cast<size_t>(level) + 1]) / pairs.at(level + 1);
    }
  }
  // Between what is smooth and what is random.
  decay_ = shorter > 0.0 ? std::clamp(longer / shorter, 0.0625, 0.5) : kEdgeDecay;
  double as_edge = 0.0, as_decayed = 0.0;
  decayed_.assign(levels_.size(), 0.0f);
  BySamples<PoolRule> rules;
  for (size_t i = 0; i < levels_.size(); ++i) {
    if (samples[i] < 2) continue;
    const PoolRule& rule = rules.get(samples[i], [&] { return PoolRule(samples[i], decay_); });
    const double pairs = 3.0 * rule.pairs.total();
    double sum = 0.0;
    for (size_t level = 0; level < kErrorLevels; ++level) {
      as_edge += levels_[i][level] * rule.edge[level] / pairs;
      sum += levels_[i][level] * rule.decayed[level] / pairs;
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
  BySamples<double> growth;  // of the variance that there was over the one that there is
  for (size_t i = 0; i < samples.size(); ++i) {
    open += static_cast<double>(first_samples_) / samples[i];
    if (samples[i] <= first_samples_) continue;
    seemed += first_variances_[i];
    proved += decayed_[i] * growth.get(samples[i], [&] {
      const double octaves = elementary::log2(static_cast<double>(samples[i]) / first_samples_);
      return elementary::exp2(-elementary::log2(decay_) * octaves);
    });
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

std::array<const uint8_t*, 3> ErrorMap::shown_at(int x, int y) const {
  const uint8_t* const first = shown_.data() + at(x, y);
  return {first, first + own_.size(), first + 2 * own_.size()};
}

void ErrorMap::spread(const Film& film, const TileRect& part) {
  for (int x = part.x0; x < part.x1; x += kRunPx)
    spread_strip(film, {x, part.y0, std::min(x + kRunPx, part.x1), part.y1});
}

void ErrorMap::spread_strip(const Film& film, const TileRect& strip) {
  const size_t pixels = static_cast<size_t>(strip.width()), cells = (pixels + kCellPx - 1) / kCellPx;
  const float unseen_of_cell = static_cast<float>(unseen_ / static_cast<double>(levels_.size()));
  std::array<ShownRow, 3> shown;  // by y modulo three, from -1
  const auto load = [&](int y) {
    load_shown(shown_at(strip.x0 - 1, y), pixels, shown[static_cast<size_t>(y + 1) % 3]);
  };
  load(strip.y0 - 1), load(strip.y0);
  Neighbourhood around;
  for (int top = strip.y0; top < strip.y1; top += kCellPx) {
    const size_t first_cell = film.cell_at(strip.x0, top);
    std::array<float, kRunPx / kCellPx> sums{};
    for (size_t i = 0; i < pixels; ++i) {
      const float unseen = kUnseen / static_cast<float>(std::max(1u, film.samples()[first_cell + i / kCellPx]));
      around.unseen[i] = unseen * unseen;
    }
    for (int y = top; y < std::min(top + kCellPx, strip.y1); ++y) {
      load(y + 1);
      const int rows = 3 - (y == 0) - (y == height_ - 1);
      for (size_t i = 0; i < pixels; ++i) around.count[i] = static_cast<float>(3 * rows);
      if (strip.x0 == 0) around.count[0] -= static_cast<float>(rows);
      if (strip.x1 == width_) around.count[pixels - 1] -= static_cast<float>(rows);
      for (int row = 0; row < 3; ++row) {
        around.own[static_cast<size_t>(row)] = &own_[at(strip.x0, y - 1 + row)];
        around.shown[static_cast<size_t>(row)] = &shown[static_cast<size_t>(y + row) % 3];
      }
      float* const variances = &variances_[static_cast<size_t>(y) * width_ + strip.x0];
      spread_row(around, pixels, scale_, variances);
      for (size_t i = 0; i < pixels; ++i) sums[i / kCellPx] += variances[i];
    }
    for (size_t i = 0; i < cells; ++i) cell_variances_[first_cell + i] = sums[i] + unseen_of_cell;
  }
}

ErrorSummary ErrorMap::summary() const {
  ErrorSummary out;
  out.is_known = is_known_;
  if (!is_known_) return out;
  double sum = unseen_, squares = 0.0;
  float most = 0.0f;
  std::array<uint32_t, 1 << 13> counts{};  // by the upper bits of the variance: steps of 1/16 octave
  constexpr int kShift = 32 - 13;
  for_each_pixel({0, 0, width_, height_}, [&](int x, int y) {
    const double own = static_cast<double>(own_[at(x, y)]) * scale_;
    sum += own;
    squares += own * own;
    const float variance = variances_[static_cast<size_t>(y) * width_ + x];
    most = std::max(most, variance);
    out.unconverged += variance > kConverged * kConverged;
    ++counts[std::bit_cast<uint32_t>(variance) >> kShift];
  });
  const double pixels = static_cast<double>(variances_.size());
  out.rmse = std::sqrt(sum / pixels);
  // Pixels are scrambled apart, so their errors are independent; an estimate from seven differences is good to its
  // half.
  const double chance = sum > 0.0 ? squares / (sum * sum) : 0.0;
  const double reach = kNormal95 * std::sqrt(kSystematic * kSystematic + chance);
  out.low = out.rmse * std::max(0.0, 1.0 - reach);
  out.high = out.rmse * (1.0 + reach);
  uint64_t above = 0;
  uint32_t bucket = static_cast<uint32_t>(counts.size());
  while (bucket > 0 && (above += counts[--bucket]) <= variances_.size() / 100) continue;
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
