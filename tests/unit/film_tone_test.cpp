// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "renderer/base/hash.h"
#include "renderer/film/film.h"
#include "renderer/film/tone.h"

namespace tilelight {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

// IEC 61966-2-1 by the C library's power.
double curve(double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055; }

TEST(Tone, TheCurveIsThatOfTheStandard) {
  for (int i = 0; i <= 10'000; ++i) {
    const double v = i / 10'000.0;
    ASSERT_NEAR(srgb_from_linear(v), curve(v), 1e-15) << v;
    ASSERT_NEAR(linear_from_srgb(srgb_from_linear(v)), v, 2e-8) << v;  // the standard's own gap at the joint
  }
  EXPECT_EQ(srgb_from_linear(0.0), 0.0);
  EXPECT_EQ(srgb_from_linear(1.0), 1.0);
  EXPECT_EQ(linear_from_srgb(1.0), 1.0);
}

TEST(Tone, MiddleGreysAreTheKnownBytes) {
  // 18 % grey and half light, as every table of sRGB lists them.
  EXPECT_EQ(to_srgb8({3, 1, {0.18f, 0.5f, 0.2158605f, 0, 1, 2, -1, 0, 0}}, 0.0),
            (std::vector<uint8_t>{118, 188, 128, 0, 255, 255, 0, 0, 0}));
}

TEST(Tone, ExposureCountsStops) {
  EXPECT_DOUBLE_EQ(displayed(0.125, 2.0), curve(0.5));
  EXPECT_DOUBLE_EQ(displayed(0.125, -1.0), curve(0.0625));
  EXPECT_EQ(displayed(3.0, 0.0), 1.0);
}

TEST(Tone, WhatIsNotANumberIsBlackAndInfinityIsWhite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(displayed(nan, 0.0), 0.0);
  EXPECT_EQ(to_srgb8({2, 1, {nan, -nan, kInf, -kInf, -0.0f, 1e-45f}}, 0.0), (std::vector<uint8_t>{0, 0, 255, 0, 0, 0}));
}

TEST(Tone, BytesAreTheExactFormulaRoundedHalfUp) {
  for (double exposure : {0.0, 0.7, -3.3, 12.0, -40.0, 300.0, -2000.0, 2000.0}) {
    Image image{1, 1, {}};
    for (uint64_t i = 0; i < 60'000; ++i) {  // every magnitude of float
      image.rgb.push_back(std::bit_cast<float>(static_cast<uint32_t>(mix64(i) & 0x7FFF'FFFFu)));
      image.rgb.push_back(static_cast<float>(static_cast<double>(mix64(i) >> 11) * 0x1p-53 * std::exp2(-exposure)));
    }
    const auto bytes = to_srgb8(image, exposure);
    for (size_t i = 0; i < bytes.size(); ++i)
      ASSERT_EQ(bytes[i], std::floor(255.0 * displayed(image.rgb[i], exposure) + 0.5)) << image.rgb[i];
  }
}

TEST(Tone, BytesAreExactBesideEveryStep) {
  Image image{1, 1, {}};
  for (int k = 1; k < 256; ++k) {
    float v = static_cast<float>(linear_from_srgb((k - 0.5) / 255.0));
    for (int i = 0; i < 8; ++i) v = std::nextafter(v, 0.0f);
    for (int i = 0; i < 16; ++i) image.rgb.push_back(v = std::nextafter(v, 2.0f));
  }
  const auto bytes = to_srgb8(image, 0.0);
  for (size_t i = 0; i < bytes.size(); ++i)
    ASSERT_EQ(bytes[i], std::floor(255.0 * displayed(image.rgb[i], 0.0) + 0.5)) << image.rgb[i];
}

TEST(Film, TilesCoverEveryPixelOnce) {
  for (auto [width, height, tile] : {std::array{1, 1, 8}, {64, 64, 16}, {65, 33, 16}, {7, 100, 1}, {30, 20, 64}}) {
    std::vector<int> seen(static_cast<size_t>(width) * height);
    for (int i = 0; i < tile_count(width, height, tile); ++i) {
      const TileRect r = tile_rect(i, width, height, tile);
      ASSERT_GT(r.pixel_count(), 0);
      for (int y = r.y0; y < r.y1; ++y)
        for (int x = r.x0; x < r.x1; ++x) ++seen[static_cast<size_t>(y) * width + x];
    }
    for (int count : seen) ASSERT_EQ(count, 1);
  }
}

}  // namespace
}  // namespace tilelight
