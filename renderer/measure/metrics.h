// SPDX-License-Identifier: Apache-2.0
// How far two images of the same view are apart, in numbers that bounds can be set on. Pure; any thread.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/measure/reference.h"

namespace tilelight {

// What a renderer showed of a view.
struct ShownImage {
  std::vector<uint8_t> rgb;           // sRGB, 3 bytes a pixel
  std::vector<uint64_t> primary_ids;  // one a pixel, see surface_id
};

// The reference's pixels as a display would show them.
ShownImage shown_image(const std::vector<ReferencePixel>& pixels, int width, int height, double exposure_stops);

struct ImageDifference {
  int64_t pixels = 0;
  int64_t id_mismatches = 0;  // pixels whose first surface differs
  int64_t q8_differing = 0;   // pixels of which a byte differs, those of fine checkers left out
  int64_t fine_checker = 0;   // pixels that see a checker cell under kFineCheckerPx
  int64_t fine_checker_differing = 0;
  int64_t q8_over_one = 0;  // of q8_differing: by more than one level
  int max_levels = 0;       // largest difference of a byte, fine checkers left out
  double rmse = 0.0;        // over all pixels and channels, displayed values in [0, 1]

  double id_mismatch_rate() const { return rate(id_mismatches); }
  double q8_rate() const { return rate(q8_differing); }

 private:
  double rate(int64_t count) const { return pixels ? static_cast<double>(count) / static_cast<double>(pixels) : 0.0; }
};

inline constexpr double kFineCheckerPx = 0.25;

// REQUIRES: both images of the size of `reference`, whose checker cells say which pixels count apart.
ImageDifference compare_images(const ShownImage& tested, const ShownImage& shown_reference,
                               const std::vector<ReferencePixel>& reference);

}  // namespace tilelight
