// SPDX-License-Identifier: Apache-2.0
// The numbers of image error, on images whose numbers are known by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "renderer/film/tone.h"
#include "renderer/measure/flip.h"
#include "renderer/measure/image_error.h"
#include "renderer/measure/ssim.h"

namespace tilelight {
namespace {

DisplayedImage flat(int width, int height, const std::array<float, 3>& color) {
  DisplayedImage out{width, height, {}};
  for (int i = 0; i < width * height; ++i) out.rgb.insert(out.rgb.end(), color.begin(), color.end());
  return out;
}

TEST(ImageError, IsNothingBetweenEqualImages) {
  Image image{8, 6, std::vector<float>(8 * 6 * 3)};
  for (size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = static_cast<float>(i % 17) / 16.0f;
  const ImageError e = image_error(image, image, 0.0);
  EXPECT_EQ(e.rmse, 0.0);
  EXPECT_EQ(e.most, 0.0);
  EXPECT_EQ(e.rel_mse, 0.0);
  EXPECT_TRUE(std::isinf(e.psnr_db));
  EXPECT_NEAR(e.ssim, 1.0, 1e-12);
  EXPECT_EQ(e.flip, 0.0);
}

// One pixel of a hundred is white where black is true.
TEST(ImageError, CountsOnePixelOfAHundred) {
  const Image truth{10, 10, std::vector<float>(300, 0.0f)};
  Image tested = truth;
  for (const size_t channel : {0u, 1u, 2u}) tested.rgb[channel] = 1.0f;
  const ImageError e = image_error(tested, truth, 0.0);
  EXPECT_NEAR(e.rmse, 0.1, 1e-12);     // sqrt(1 / 100)
  EXPECT_NEAR(e.psnr_db, 20.0, 1e-9);  // -20 log10(0.1)
  EXPECT_NEAR(e.rel_mse, 1.0, 1e-9);   // (1 / 0.01) / 100
  EXPECT_EQ(e.p99, 0.0);               // 99 of 100 are right
  EXPECT_EQ(e.most, 1.0);
}

TEST(ImageError, IsOfWhatADisplayShows) {
  const Image truth{2, 2, std::vector<float>(12, 3.0f)}, tested{2, 2, std::vector<float>(12, 1.5f)};
  EXPECT_EQ(image_error(tested, truth, 0.0).rmse, 0.0);  // both are white
  EXPECT_NEAR(image_error(tested, truth, -2.0).rmse, displayed(0.75, 0.0) - displayed(0.375, 0.0), 1e-6);
}

// For flat images SSIM is its first factor alone: (2ab + C1) / (a^2 + b^2 + C1).
TEST(Ssim, OfFlatImagesIsThatOfTheirMeans) {
  const double a = 0.25, b = 0.75, c1 = 1e-4;
  const double closed = (2 * a * b + c1) / (a * a + b * b + c1);
  EXPECT_NEAR(ssim(flat(20, 14, {0.25f, 0.25f, 0.25f}), flat(20, 14, {0.75f, 0.75f, 0.75f})), closed, 1e-6);
}

// A negative has the same contrast and the opposite structure.
TEST(Ssim, OfANegativeIsNegative) {
  DisplayedImage image = flat(32, 32, {0.0f, 0.0f, 0.0f});
  for (size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = ((i / 3) % 32 / 2 + (i / 96) / 2) % 2 ? 0.9f : 0.1f;
  DisplayedImage negative = image;
  for (float& v : negative.rgb) v = 1.0f - v;
  EXPECT_LT(ssim(image, negative), -0.9);
}

// Without edges FLIP is its curve of the HyAB distance alone; the numbers are worked out by hand from the paper's
// formulas.
TEST(Flip, OfFlatImagesIsTheDistanceOfTheirColors) {
  const auto mean = [](const std::array<float, 3>& a, const std::array<float, 3>& b) {
    return mean_flip(flat(12, 9, a), flat(12, 9, b));
  };
  EXPECT_NEAR(mean({1, 1, 1}, {0, 0, 0}), 0.96738052, 1e-6);
  EXPECT_NEAR(mean({1, 0, 0}, {0, 1, 0}), 0.98666231, 1e-6);
  EXPECT_NEAR(mean({0.5f, 0.5f, 0.5f}, {0.55f, 0.55f, 0.55f}), 0.17646368, 1e-6);
  EXPECT_NEAR(mean({0, 1, 0}, {0, 0, 1}), 1.0, 1e-9);  // the farthest that it knows
}

// The eye forgives noise that it cannot follow: the same error in every second pixel of a fine checker counts less than
// over an area.
TEST(Flip, ForgivesWhatTheEyeDoesNotSee) {
  const DisplayedImage truth = flat(48, 48, {0.5f, 0.5f, 0.5f});
  DisplayedImage noise = truth, area = truth;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 48; ++x) {
      for (int c = 0; c < 3; ++c) {
        const size_t i = static_cast<size_t>(3 * (48 * y + x) + c);
        noise.rgb[i] += (x + y) % 2 ? 0.1f : -0.1f;
        area.rgb[i] += x < 24 ? 0.1f : -0.1f;
      }
    }
  }
  EXPECT_LT(mean_flip(noise, truth), 0.5 * mean_flip(area, truth));
  EXPECT_NEAR(rms_difference(noise, truth), rms_difference(area, truth), 1e-7);
}

}  // namespace
}  // namespace tilelight
