// SPDX-License-Identifier: Apache-2.0
// PNG, JPEG and OpenEXR in memory (OpenEXR, and what is read, by OpenImageIO), and the names and limits of the formats
// of pictures. A target of its own (tl_image_io): loading the library costs 0.3 s. Any thread. Whatever a library
// makes of a picture is a result or an error; none ends the process.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/base/result.h"
#include "renderer/film/film.h"

namespace tilelight {

// svg is of line drawings: their render writes it (Render::lines_svg). It is refused wherever pixels are meant, with
// the error no_pixels.
enum class ImageFormat { png, jpeg, exr, svg };

std::optional<ImageFormat> image_format_from_extension(std::string_view path);         // "a.png" -> png
std::optional<ImageFormat> image_format_from_media_type(std::string_view media_type);  // "image/png" -> png
std::string_view media_type(ImageFormat format);

// The longest side that a picture of the format may have, in pixels.
int max_image_side(ImageFormat format);
// Error format_limit, which names the limit, where a picture of this size does not fit.
Result<void> check_image_size(ImageFormat format, int width, int height);

// Encodes a linear image. PNG and JPEG: exposure, clamp to [0, 1], sRGB, 8 bit. EXR: linear 32-bit floats times
// 2^exposure, clamped to what such a float can hold. NaN becomes 0. The same image gives the same bytes.
// Errors: no_pixels, format_limit, out_of_memory, encode_failed, image_format_unavailable.
Result<std::string> encode_image(const Image& image, double exposure_stops, ImageFormat format);

// How many of the image's values (three a pixel) the format cannot hold, so that encode_image changes them: in an EXR
// what is over the largest float after exposure, in PNG and JPEG, which are clamped to what a display shows anyway,
// what is infinite before it; in all NaN.
int64_t count_clamped(const Image& image, double exposure_stops, ImageFormat format);
// The same for people. REQUIRES: count > 0.
std::string clamped_warning(int64_t count, ImageFormat format);

// Reads 8-bit sRGB back (for tests and tools). Grey is spread over RGB, alpha is dropped, an EXR's linear values are
// displayed at exposure 0. Only the declared format's decoder sees the bytes. Errors: bad_image, image_too_large;
// dimensions are checked against max_pixels before memory for pixels is taken.
struct Rgb8Image {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;
};
Result<Rgb8Image> decode_image(std::string_view bytes, ImageFormat format, int64_t max_pixels);

// The same as linear light.
Result<Image> decode_linear(std::string_view bytes, ImageFormat format, int64_t max_pixels);

}  // namespace tilelight
