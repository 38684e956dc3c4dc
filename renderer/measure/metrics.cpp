// SPDX-License-Identifier: Apache-2.0
#include "renderer/measure/metrics.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "renderer/film/tone.h"

namespace tilelight {

ShownImage shown_image(const std::vector<ReferencePixel>& pixels, int width, int height, double exposure_stops) {
  Image image{width, height, {}};
  image.rgb.reserve(pixels.size() * 3);
  ShownImage shown;
  shown.primary_ids.reserve(pixels.size());
  for (const ReferencePixel& pixel : pixels) {
    for (int channel = 0; channel < 3; ++channel) image.rgb.push_back(static_cast<float>(pixel.color[channel]));
    shown.primary_ids.push_back(pixel.primary_id);
  }
  shown.rgb = to_srgb8(image, exposure_stops);
  return shown;
}

ImageDifference compare_images(const ShownImage& tested, const ShownImage& shown_reference,
                               const std::vector<ReferencePixel>& reference) {
  ImageDifference result;
  result.pixels = static_cast<int64_t>(reference.size());
  int64_t squares = 0;
  for (size_t i = 0; i < reference.size(); ++i) {
    int levels = 0;
    for (size_t byte = 3 * i; byte < 3 * i + 3; ++byte) {
      const int d = std::abs(tested.rgb[byte] - shown_reference.rgb[byte]);
      levels = std::max(levels, d);
      squares += d * d;
    }
    if (tested.primary_ids[i] != shown_reference.primary_ids[i]) ++result.id_mismatches;
    if (reference[i].checker_cell_px < kFineCheckerPx) {
      ++result.fine_checker;
      if (levels > 0) ++result.fine_checker_differing;
      continue;
    }
    if (levels > 0) ++result.q8_differing;
    if (levels > 1) ++result.q8_over_one;
    result.max_levels = std::max(result.max_levels, levels);
  }
  if (!reference.empty())
    result.rmse = std::sqrt(static_cast<double>(squares) / (3.0 * static_cast<double>(reference.size()))) / 255.0;
  return result;
}

}  // namespace tilelight
