// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <regex>
#include <string>
#include <thread>

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

#include "renderer/film/image_io.h"
#include "renderer/film/tone.h"

namespace tilelight {
namespace {

// OpenImageIO 2.4 loses one message of 31 bytes when a PNG ends early: libpng's longjmp passes over a std::string of
// PNGInput::PngReadCallback. Nothing else is excused: only what is allocated while this object lives.
struct LeaksOfTheLibrary {
#ifdef __SANITIZE_ADDRESS__
  __lsan::ScopedDisabler disabler;
#endif
};

// A smooth picture with values beyond both ends of the displayed range.
Image gradient(int width, int height) {
  Image image{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) image.rgb.push_back(static_cast<float>(1.5 * x / width - 0.1 + 0.2 * c * y / height));
  return image;
}

TEST(ImageIo, PngKeepsEveryByte) {
  const Image image = gradient(97, 61);
  const auto bytes = encode_image(image, -0.5, ImageFormat::png);
  ASSERT_TRUE(bytes) << bytes.error().detail;
  const auto back = decode_image(*bytes, ImageFormat::png, 1 << 20);
  ASSERT_TRUE(back) << back.error().detail;
  EXPECT_EQ(back->width, 97);
  EXPECT_EQ(back->height, 61);
  EXPECT_EQ(back->rgb, to_srgb8(image, -0.5));
}

TEST(ImageIo, PngKeepsEveryByteOfAnySizeAndContent) {
  uint32_t random = 1;
  for (const auto& [width, height] : {std::pair(1, 1), {1, 300}, {701, 1}, {3, 2}, {256, 256}, {600, 500}}) {
    for (const int kind : {0, 1, 2}) {  // one colour, stripes that one filter or the other leaves nothing of, noise
      Image image{width, height, {}};
      for (int i = 0; i < width * height * 3; ++i) {
        random = 1664525 * random + 1013904223;
        const int row = i / (3 * width);
        image.rgb.push_back(kind == 0   ? 0.2f
                            : kind == 1 ? static_cast<float>((row % 2 ? row : i / 3 % width) % 7) / 7.0f
                                        : static_cast<float>(random >> 8) * 0x1p-24f);
      }
      const auto bytes = encode_image(image, 0.0, ImageFormat::png);
      ASSERT_TRUE(bytes);
      const auto back = decode_image(*bytes, ImageFormat::png, 1 << 20);
      ASSERT_TRUE(back) << back.error().detail;
      EXPECT_EQ(std::pair(back->width, back->height), std::pair(width, height));
      EXPECT_TRUE(back->rgb == to_srgb8(image, 0.0)) << width << "x" << height << " " << kind;
    }
  }
}

TEST(ImageIo, PngSaysThatItIsSrgbAndHoldsNoTime) {
  const auto bytes = encode_image(gradient(8, 8), 0.0, ImageFormat::png);
  ASSERT_TRUE(bytes);
  EXPECT_NE(bytes->find("sRGB"), std::string::npos);
  EXPECT_EQ(bytes->find("tIME"), std::string::npos);
}

TEST(ImageIo, NoFormatHoldsTheTimeOfDay) {
  const std::regex time(R"(\d\d\d\d:\d\d:\d\d)");
  for (const ImageFormat format : {ImageFormat::png, ImageFormat::jpeg, ImageFormat::exr}) {
    const auto bytes = encode_image(gradient(8, 8), 0.0, format);
    ASSERT_TRUE(bytes) << bytes.error().detail;
    EXPECT_FALSE(std::regex_search(*bytes, time)) << "of one picture every second has other bytes";
  }
}

TEST(ImageIo, AnSvgHasANameButNoPixels) {
  EXPECT_EQ(image_format_from_extension("a/lines.SVG"), ImageFormat::svg);
  EXPECT_EQ(image_format_from_media_type("image/svg+xml"), ImageFormat::svg);
  EXPECT_EQ(media_type(ImageFormat::svg), "image/svg+xml");
  EXPECT_EQ(encode_image(gradient(8, 8), 0.0, ImageFormat::svg).error().code, "no_pixels");
  EXPECT_EQ(decode_image("<svg/>", ImageFormat::svg, 1 << 20).error().code, "no_pixels");
  EXPECT_EQ(decode_linear("<svg/>", ImageFormat::svg, 1 << 20).error().code, "no_pixels");
}

TEST(ImageIo, JpegIsCloseOnASmoothPicture) {
  const Image image = gradient(128, 64);
  const auto bytes = encode_image(image, 0.0, ImageFormat::jpeg);
  ASSERT_TRUE(bytes) << bytes.error().detail;
  const auto back = decode_image(*bytes, ImageFormat::jpeg, 1 << 20);
  ASSERT_TRUE(back) << back.error().detail;
  const auto expected = to_srgb8(image, 0.0);
  ASSERT_EQ(back->rgb.size(), expected.size());
  double square = 0.0;
  for (size_t i = 0; i < expected.size(); ++i) square += std::pow(back->rgb[i] - expected[i], 2.0);
  EXPECT_LT(std::sqrt(square / expected.size()), 3.0);
}

// What an EXR of the values (three a pixel) holds.
std::vector<float> through_exr(const Image& image, double exposure_stops = 0.0) {
  const auto bytes = encode_image(image, exposure_stops, ImageFormat::exr);
  if (!bytes) return ADD_FAILURE() << bytes.error().detail, std::vector<float>();
  const auto back = decode_linear(*bytes, ImageFormat::exr, 1 << 24);
  if (!back) return ADD_FAILURE() << back.error().detail, std::vector<float>();
  EXPECT_EQ(std::pair(back->width, back->height), std::pair(image.width, image.height));
  return back->rgb;
}

constexpr float kMostFloat = std::numeric_limits<float>::max(), kInfinity = std::numeric_limits<float>::infinity(),
                kNan = std::numeric_limits<float>::quiet_NaN();

TEST(ImageIo, ExrKeepsEveryBitOfLinearValues) {
  Image image = gradient(40, 30);
  EXPECT_EQ(through_exr(image), image.rgb);
  // The largest half, the first over it, the largest float; its least normal number, its least at all.
  image = {3, 1, {65504.0f, 65520.0f, -70000.0f, kMostFloat, -kMostFloat, 1e30f, 0x1p-126f, 0x1p-149f, -0x1p-149f}};
  EXPECT_EQ(through_exr(image), image.rgb);
  EXPECT_EQ(count_clamped(image, 0.0, ImageFormat::exr), 0);
}

TEST(ImageIo, ExrClampsWhatAFloatCannotHoldAndCountsIt) {
  const Image image{3, 1, {kMostFloat, -kMostFloat, 1.0f, kInfinity, -kInfinity, kNan, 0.5f, 0.0f, 1e30f}};
  const std::vector<float> doubled = {kMostFloat, -kMostFloat, 2.0f, kMostFloat, -kMostFloat, 0.0f, 1.0f, 0.0f, 2e30f};
  EXPECT_EQ(through_exr(image, 1.0), doubled);
  EXPECT_EQ(count_clamped(image, 1.0, ImageFormat::exr), 5);
  EXPECT_EQ(count_clamped(image, 0.0, ImageFormat::exr), 3) << "the largest float is one";
  // 2^1000 leaves even doubles.
  EXPECT_EQ(through_exr(image, 1000.0)[2], kMostFloat);
  EXPECT_EQ(count_clamped(image, 1000.0, ImageFormat::exr), 8) << "all but 0";
  EXPECT_EQ(through_exr(image, -1000.0)[2], 0.0f);
}

TEST(ImageIo, ADisplayShowsInfinityAsWhiteAndNanAsBlackAndBothAreCounted) {
  const Image image{2, 1, {kInfinity, -kInfinity, kNan, 1e30f, 0.0f, 1.0f}};
  const auto back = decode_image(*encode_image(image, 0.0, ImageFormat::png), ImageFormat::png, 2);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->rgb, (std::vector<uint8_t>{255, 0, 0, 255, 0, 255}));
  for (const ImageFormat format : {ImageFormat::png, ImageFormat::jpeg})
    EXPECT_EQ(count_clamped(image, 0.0, format), 3) << "what is over white is no loss there";
  EXPECT_EQ(count_clamped(image, 1000.0, ImageFormat::png), 3);
}

Image grey(int width, int height) {
  return {width, height, std::vector<float>(3 * static_cast<size_t>(width) * static_cast<size_t>(height), 0.25f)};
}

TEST(ImageIo, EveryFormatHoldsASideUpToItsLimitAndRefusesALongerOneByName) {
  for (const ImageFormat format : {ImageFormat::png, ImageFormat::jpeg}) {
    const int side = max_image_side(format);
    for (const auto& [width, height] : {std::pair(side, 1), {1, side}}) {
      const auto bytes = encode_image(grey(width, height), 0.0, format);
      ASSERT_TRUE(bytes) << bytes.error().detail;
      const auto back = decode_linear(*bytes, format, side);
      ASSERT_TRUE(back) << media_type(format) << ": " << back.error().detail;
      EXPECT_EQ(std::pair(back->width, back->height), std::pair(width, height));
      EXPECT_NEAR(back->rgb.back(), 0.25, 0.01);
    }
    for (const auto& [width, height] : {std::pair(side + 1, 1), {1, side + 1}}) {
      const auto refused = encode_image(grey(width, height), 0.0, format);
      ASSERT_FALSE(refused) << media_type(format);
      EXPECT_EQ(refused.error().code, "format_limit");
      EXPECT_NE(refused.error().detail.find(std::to_string(side)), std::string::npos) << refused.error().detail;
      EXPECT_NE(refused.error().detail.find(std::to_string(side + 1)), std::string::npos) << refused.error().detail;
    }
  }
  EXPECT_EQ(max_image_side(ImageFormat::jpeg), 65'500) << "libjpeg's";
  EXPECT_EQ(max_image_side(ImageFormat::png), 1'000'000) << "libpng's, of who reads it";
}

TEST(ImageIo, AnExrMayBeLongerThanAllOthers) {
  const Image image = grey(1'000'001, 1);
  EXPECT_TRUE(through_exr(image) == image.rgb);
  EXPECT_FALSE(check_image_size(ImageFormat::exr, 1, 1 << 30)) << "what memory has room for comes first";
}

TEST(ImageIo, JpegsOfAnySizeAreWhole) {
  for (const auto& [width, height] :
       {std::pair(1, 1), {1, 17}, {17, 1}, {15, 16}, {16, 15}, {257, 129}, {2000, 1500}}) {
    const auto back =
        decode_image(*encode_image(grey(width, height), 0.0, ImageFormat::jpeg), ImageFormat::jpeg, 1 << 24);
    ASSERT_TRUE(back) << back.error().detail;
    EXPECT_EQ(std::pair(back->width, back->height), std::pair(width, height));
    const auto [least, most] = std::minmax_element(back->rgb.begin(), back->rgb.end());
    EXPECT_LE(*most - *least, 1) << "one grey";
    EXPECT_NEAR(*least, 137, 1) << "0.25 displayed";
  }
}

TEST(ImageIo, AJpegThatIsBrokenIsAnErrorAndNoEnd) {
  const auto whole = *encode_image(gradient(64, 64), 0.0, ImageFormat::jpeg);
  for (size_t size = 0; size < whole.size() / 2; size += 7) {
    const auto back = decode_image(std::string_view(whole).substr(0, size), ImageFormat::jpeg, 1 << 20);
    EXPECT_TRUE(size >= 600 || !back) << size << ": its head is not there";
  }
  for (size_t at = 2; at < whole.size(); at += 11) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(~bytes[at]);
    static_cast<void>(decode_image(bytes, ImageFormat::jpeg, 1 << 20));
  }
}

TEST(ImageIo, TheSameImageGivesTheSameBytesOnAnyThread) {
  const Image image = gradient(64, 48);
  for (ImageFormat format : {ImageFormat::png, ImageFormat::jpeg, ImageFormat::exr}) {
    const auto here = encode_image(image, 0.0, format);
    ASSERT_TRUE(here);
    std::string there;
    std::jthread([&] { there = *encode_image(image, 0.0, format); }).join();
    EXPECT_TRUE(*here == there) << media_type(format);
  }
}

TEST(ImageIo, ReadsBackWhatLinearLightItWrote) {
  const Image image{2, 1, {0.0f, 0.5f, 1.0f, 0.25f, 0.75f, 0.01f}};
  const auto back = decode_linear(*encode_image(image, 0.0, ImageFormat::png), ImageFormat::png, 2);
  ASSERT_TRUE(back);
  for (size_t i = 0; i < 6; ++i) EXPECT_NEAR(back->rgb[i], image.rgb[i], 0.005) << i;
}

TEST(ImageIo, RefusesAnImageThatIsTooLargeBeforeReadingIt) {
  auto bytes = *encode_image(gradient(16, 16), 0.0, ImageFormat::png);
  EXPECT_TRUE(decode_image(bytes, ImageFormat::png, 256));
  EXPECT_EQ(decode_image(bytes, ImageFormat::png, 255).error().code, "image_too_large");
  EXPECT_EQ(decode_image(*encode_image(gradient(16, 16), 0.0, ImageFormat::exr), ImageFormat::exr, 255).error().code,
            "image_too_large");
}

TEST(ImageIo, RefusesBytesThatAreNotOfTheDeclaredFormat) {
  const auto png = *encode_image(gradient(16, 16), 0.0, ImageFormat::png);
  for (ImageFormat format : {ImageFormat::png, ImageFormat::jpeg, ImageFormat::exr}) {
    EXPECT_FALSE(decode_image("", format, 1 << 20)) << media_type(format);
    EXPECT_FALSE(decode_image("not an image at all, only some words", format, 1 << 20)) << media_type(format);
    if (format != ImageFormat::png) {
      EXPECT_FALSE(decode_image(png, format, 1 << 20)) << media_type(format);
    }
  }
  [[maybe_unused]] const LeaksOfTheLibrary ignored;
  EXPECT_FALSE(decode_image(std::string_view(png).substr(0, png.size() / 2), ImageFormat::png, 1 << 20));
}

TEST(ImageIo, FormatsAreNamedByExtensionAndMediaType) {
  EXPECT_EQ(image_format_from_extension("a/b.c/d.PNG"), ImageFormat::png);
  EXPECT_EQ(image_format_from_extension("x.jpg"), ImageFormat::jpeg);
  EXPECT_EQ(image_format_from_extension("x.jpeg"), ImageFormat::jpeg);
  EXPECT_EQ(image_format_from_extension("x.exr"), ImageFormat::exr);
  EXPECT_EQ(image_format_from_extension("x.gif"), std::nullopt);
  EXPECT_EQ(image_format_from_extension("png"), std::nullopt);
  EXPECT_EQ(image_format_from_extension("x."), std::nullopt);
  for (ImageFormat format : {ImageFormat::png, ImageFormat::jpeg, ImageFormat::exr})
    EXPECT_EQ(image_format_from_media_type(media_type(format)), format);
  EXPECT_EQ(image_format_from_media_type("text/html"), std::nullopt);
}

}  // namespace
}  // namespace tilelight
