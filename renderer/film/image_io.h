// SPDX-License-Identifier: Apache-2.0
// PNG, JPEG and OpenEXR by OpenImageIO, in memory. A target of its own (tl_image_io): loading the library costs 0.3 s.
// Any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/base/result.h"
#include "renderer/film/film.h"

namespace tilelight {

enum class ImageFormat { png, jpeg, exr };

std::optional<ImageFormat> image_format_from_extension(std::string_view path);  // "a.png" -> png
std::optional<ImageFormat> image_format_from_media_type(std::string_view media_type);  // "image/png" -> png
std::string_view media_type(ImageFormat format);

// Encodes a linear image. PNG and JPEG: exposure, clamp, sRGB, 8 bit. EXR: linear half floats times 2^exposure,
// unclamped. The same image gives the same bytes.
Result<std::string> encode_image(const Image& image, double exposure_stops, ImageFormat format);

// Reads 8-bit RGB back (for tests and tools). Dimensions are checked against max_pixels before pixels are read.
struct Rgb8Image {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;
};
Result<Rgb8Image> decode_image(std::string_view bytes, ImageFormat format, int64_t max_pixels);

}  // namespace tilelight
