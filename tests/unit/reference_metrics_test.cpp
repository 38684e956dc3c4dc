// SPDX-License-Identifier: Apache-2.0
// The counts by which two images are compared, on images made by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/measure/metrics.h"

namespace tilelight {
namespace {

// Four grey pixels; the last one sees a checker of tiny cells.
std::vector<ReferencePixel> four_pixels() {
  std::vector<ReferencePixel> pixels(4);
  for (ReferencePixel& pixel : pixels) pixel.color = Color(0.5), pixel.primary_id = surface_id(7, 9);
  pixels[3].checker_cell_px = 0.1;
  return pixels;
}

TEST(ImageMetrics, CountNothingBetweenEqualImages) {
  const auto pixels = four_pixels();
  const ShownImage shown = shown_image(pixels, 2, 2, 0.0);
  EXPECT_EQ(shown.rgb, std::vector<uint8_t>(12, 188));  // sRGB of 0.5
  const ImageDifference d = compare_images(shown, shown, pixels);
  EXPECT_EQ(d.pixels, 4);
  EXPECT_EQ(d.id_mismatches + d.q8_differing + d.fine_checker_differing + d.max_levels, 0);
  EXPECT_EQ(d.rmse, 0.0);
}

TEST(ImageMetrics, CountPixelsAndNotChannelsAndFineCheckersApart) {
  const auto pixels = four_pixels();
  const ShownImage shown = shown_image(pixels, 2, 2, 0.0);
  ShownImage tested = shown;
  tested.rgb[0] += 3, tested.rgb[1] -= 1, tested.rgb[4] += 1, tested.rgb[9] -= 50;
  tested.primary_ids[2] = kNothingHit;
  const ImageDifference d = compare_images(tested, shown, pixels);
  EXPECT_EQ(d.q8_differing, 2);
  EXPECT_EQ(d.q8_over_one, 1);
  EXPECT_EQ(d.max_levels, 3);
  EXPECT_EQ(d.fine_checker, 1);
  EXPECT_EQ(d.fine_checker_differing, 1);
  EXPECT_EQ(d.id_mismatches, 1);
  EXPECT_EQ(d.id_mismatch_rate(), 0.25);
  EXPECT_NEAR(d.rmse, std::sqrt((9.0 + 1.0 + 1.0 + 2500.0) / 12.0) / 255.0, 1e-15);
}

}  // namespace
}  // namespace tilelight
