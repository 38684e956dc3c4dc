// SPDX-License-Identifier: Apache-2.0
// ErrorMap: how wrong a picture is, told from its own samples. A pixel's sequence lies in aligned blocks; by how much
// two neighbouring blocks differ tells how much error goes when they are joined, and so how much is left. The error of
// a pixel is the root mean square over its channels of displayed - true, both after exposure, clamping and the sRGB
// curve, before rounding to 8 bits: black is 0 and white 1. README.md tells the formulas, and how well they do.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/film/film.h"

namespace tilelight {

struct ErrorRule;

// What the variance of a mean is multiplied by when its samples are doubled, where an edge crosses the pixel: n^-1.5.
inline constexpr double kEdgeDecay = 0.35355339059327373;

// The error of a whole picture.
struct ErrorSummary {
  bool is_known = false;         // false: nothing is, for some pixels have fewer than two samples
  double rmse = 0.0;             // over pixels and channels
  double low = 0.0, high = 0.0;  // the true rmse lies between them for 95 % of pictures
  double p99 = 0.0, most = 0.0;  // of the pixels' bounds: 99 % are below the first, none is above the second
  int64_t unconverged = 0;       // pixels whose bound is over two steps of 8 bits
};

// After each pass: measure() every part of the image, pool() once, spread() every part. Parts are of whole cells; many
// threads may do different ones, and no answer depends on parts or threads.
class ErrorMap {
 public:
  static constexpr int64_t kPixelBytes = 3 * sizeof(float) + 3;  // about, with bounds()

  ErrorMap(int width, int height, double exposure_stops);

  // What the pixels' blocks say. image: the film's, resolved.
  void measure(const Film& film, const Image& image, const TileRect& part);
  // How fast the error falls with more samples, in all the image.
  void pool(const Film& film);
  // Each pixel leans on its neighbours, which may have met what it has missed.
  void spread(const Film& film, const TileRect& part);

  ErrorSummary summary() const;
  // After pool(): what a variance is multiplied by when its pixel's samples are doubled, and by cell the sum of its
  // pixels' variances as their own samples tell them.
  double decay() const { return decay_; }
  std::vector<double> own_cell_variances() const;
  // By cell of the film: the sum of its pixels' variances.
  const std::vector<float>& cell_variances() const { return cell_variances_; }
  // By pixel: its error is below in 95 % of cases, or more.
  std::vector<float> bounds() const;

 private:
  using Levels = std::array<float, 3>;  // by distance of the blocks that are compared: kErrorLevels

  void measure_run(const Film& film, const Image& image, const TileRect& run, const ErrorRule& rule);
  void spread_strip(const Film& film, const TileRect& strip);
  void look_back(const Film& film);
  // Into own_ and the planes of shown_.
  size_t at(int x, int y) const { return static_cast<size_t>(y + 1) * stride_ + static_cast<size_t>(x + 1); }
  std::array<const uint8_t*, 3> shown_at(int x, int y) const;

  int width_, height_;
  size_t stride_;    // of the arrays that have a pixel more on every side, always 0
  double exposure_;  // a factor
  bool is_known_ = false;
  double decay_ = 1.0;
  float scale_ = 1.0f;          // of own_, once the decay is known
  std::vector<float> own_;      // variance of a pixel if an edge crossed it, from its own samples; with a margin
  std::vector<uint8_t> shown_;  // a plane for each channel: as displayed, rounded; with a margin
  std::vector<Levels> levels_;  // by cell: by how much its blocks differ
  std::vector<float> variances_;
  std::vector<float> decayed_;  // by cell: the sum of the variances, with the decay, before calibration
  // When all pixels had as many samples for the last time: how many, and the variances of the cells.
  uint32_t first_samples_ = 0;
  std::vector<float> first_variances_;
  double unseen_ = 0.0;  // variance of the picture, times its pixels, that no pixel has shown
  std::vector<float> cell_variances_;
};

}  // namespace tilelight
