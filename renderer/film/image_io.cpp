// SPDX-License-Identifier: Apache-2.0
#include "renderer/film/image_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <mutex>
#include <new>

#include "renderer/base/elementary.h"
#include "renderer/base/standard_floats.h"
#include "renderer/film/jpeg.h"
#include "renderer/film/png.h"
#include "renderer/film/tone.h"

namespace tilelight {
namespace {

struct FormatRow {
  ImageFormat format;
  const char* plugin;  // OpenImageIO's name; svg: none
  std::string_view name, media_type;
  std::array<std::string_view, 2> extensions;
  int max_side;
};
// A PNG may be longer, but libpng, by which nearly everybody reads it, refuses that unless it is told otherwise. The
// last pixel of an EXR lies before INT_MAX / 2 (OpenEXR, Header::sanityCheck).
constexpr int kNoLimit = std::numeric_limits<int>::max();
constexpr int kMaxPngSide = 1'000'000, kMaxExrSide = kNoLimit / 2;
constexpr std::array<FormatRow, 4> kFormats = {
    {{ImageFormat::png, "png", "PNG", "image/png", {"png", ""}, kMaxPngSide},
     {ImageFormat::jpeg, "jpeg", "JPEG", "image/jpeg", {"jpg", "jpeg"}, kMaxJpegSide},
     {ImageFormat::exr, "openexr", "EXR", "image/x-exr", {"exr", ""}, kMaxExrSide},
     {ImageFormat::svg, nullptr, "SVG", "image/svg+xml", {"svg", ""}, kNoLimit}}};

constexpr double kLargestFloat = std::numeric_limits<float>::max();

const FormatRow& row_of(ImageFormat format) { return kFormats[static_cast<size_t>(format)]; }

::tl::unexpected<Error> no_pixels() {
  return fail("no_pixels", "an SVG holds lines and an image pixels: neither can be made of the other");
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

// Images are encoded on the threads of the tile pool: the library must start none of its own.
void use_calling_thread_only() {
  static std::once_flag once;
  std::call_once(once, [] {
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", 1);
  });
}

std::string size_text(int width, int height) { return std::to_string(width) + " x " + std::to_string(height); }

OIIO::ImageSpec exr_spec(const Image& image) {
  OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeFloat);
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "");  // else the library writes the time of day, and one image has many bytes
  spec.attribute("oiio:ColorSpace", "Linear");
  return spec;
}

// Times 2^exposure, brought to what a float holds.
std::vector<float> exposed(const Image& image, double exposure_stops) {
  const double scale = elementary::exp2(exposure_stops);
  std::vector<float> values(image.rgb.size());
  std::transform(image.rgb.begin(), image.rgb.end(), values.begin(), [scale](float v) {
    const double value = v * scale;
    return value == value ? static_cast<float>(std::clamp(value, -kLargestFloat, kLargestFloat)) : 0.0f;
  });
  return values;
}

Result<std::string> write_exr(const Image& image, double exposure_stops) {
  use_calling_thread_only();
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(row_of(ImageFormat::exr).plugin);
  if (!output || !output->set_ioproxy(&memory))
    return fail("image_format_unavailable", "this build cannot write EXR images");
  if (!output->open("memory.exr", exr_spec(image)) ||
      !output->write_image(OIIO::TypeFloat, exposed(image, exposure_stops).data()) || !output->close())
    return fail("encode_failed", "writing an EXR: " + output->geterror());
  return std::string(bytes.begin(), bytes.end());
}

// An image file opened in memory. The reader must outlive the input, so they travel together.
struct OpenInput {
  std::unique_ptr<OIIO::Filesystem::IOMemReader> bytes;
  std::unique_ptr<OIIO::ImageInput> input;
  OIIO::ImageSpec spec;
};

Result<OpenInput> open_input(std::string_view bytes, ImageFormat format, int64_t max_pixels) {
  if (format == ImageFormat::svg) return no_pixels();
  use_calling_thread_only();
  const FormatRow& row = row_of(format);
  OpenInput open;
  open.bytes = std::make_unique<OIIO::Filesystem::IOMemReader>(bytes.data(), bytes.size());
  // By the declared type's own plugin: what the bytes claim to be never chooses the decoder.
  open.input = OIIO::ImageInput::create(row.plugin);
  if (!open.input || !open.input->set_ioproxy(open.bytes.get()))
    return fail("image_format_unavailable", std::string("this build cannot read ") + row.plugin + " images");
  if (!open.input->open(std::string("memory.") + std::string(row.extensions[0]), open.spec))
    return fail("bad_image", std::string("not a readable ") + row.plugin + " image: " + open.input->geterror());
  const OIIO::ImageSpec& spec = open.spec;
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1)
    return fail("bad_image", "the image has no pixels");
  if (static_cast<int64_t>(spec.width) * spec.height > max_pixels)
    return fail("image_too_large", "the image has " + size_text(spec.width, spec.height) + " pixels; at most " +
                                       std::to_string(max_pixels) + " are allowed");
  return open;
}

// Width * height * 3 values; grey is spread over the three channels and alpha is dropped.
template <class T>
Result<std::vector<T>> read_rgb(OpenInput& open, OIIO::TypeDesc type) {
  const int channels = open.spec.nchannels >= 3 ? 3 : 1;
  const size_t pixels = static_cast<size_t>(open.spec.width) * open.spec.height;
  std::vector<T> rgb(pixels * 3);
  if (!open.input->read_image(0, 0, 0, channels, type, rgb.data()))
    return fail("bad_image", "the image's pixels cannot be read: " + open.input->geterror());
  if (channels == 1) {
    for (size_t i = pixels; i-- > 0;) std::fill_n(rgb.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, T(rgb[i]));
  }
  return rgb;
}

}  // namespace

std::optional<ImageFormat> image_format_from_extension(std::string_view path) {
  const size_t dot = path.rfind('.');
  if (dot == std::string_view::npos) return std::nullopt;
  const std::string extension = lower_case(path.substr(dot + 1));
  for (const FormatRow& row : kFormats)
    if (!extension.empty() && (extension == row.extensions[0] || extension == row.extensions[1])) return row.format;
  return std::nullopt;
}

std::optional<ImageFormat> image_format_from_media_type(std::string_view media_type) {
  const std::string lower = lower_case(media_type);
  for (const FormatRow& row : kFormats)
    if (lower == row.media_type) return row.format;
  return std::nullopt;
}

std::string_view media_type(ImageFormat format) { return row_of(format).media_type; }

int max_image_side(ImageFormat format) { return row_of(format).max_side; }

Result<void> check_image_size(ImageFormat format, int width, int height) {
  const FormatRow& row = row_of(format);
  if (width <= row.max_side && height <= row.max_side) return {};
  std::string others;
  for (const FormatRow& other : kFormats) {
    if (other.format != ImageFormat::svg && std::max(width, height) <= other.max_side)
      others += (others.empty() ? "; " : " and ") + std::string(other.name);
  }
  return fail("format_limit", "the picture has " + size_text(width, height) + " pixels, and a side of a " +
                                  std::string(row.name) + " has at most " + std::to_string(row.max_side) + others +
                                  (others.empty() ? "" : " can hold it"));
}

Result<std::string> encode_image(const Image& image, double exposure_stops, ImageFormat format) {
  if (format == ImageFormat::svg) return no_pixels();
  if (auto fits = check_image_size(format, image.width, image.height); !fits) return ::tl::unexpected(fits.error());
  const StandardFloats floats;
  try {
    if (format == ImageFormat::exr) return write_exr(image, exposure_stops);
    const std::vector<uint8_t> rgb = to_srgb8(image, exposure_stops);
    if (format == ImageFormat::jpeg) return write_jpeg(image.width, image.height, rgb);
    return write_png(image.width, image.height, rgb);
  } catch (const std::bad_alloc&) {
    return fail("out_of_memory", "memory is short: the picture of " + size_text(image.width, image.height) +
                                     " pixels cannot be written as " + std::string(row_of(format).name) + " now");
  } catch (const std::exception& error) {
    return fail("encode_failed", "writing " + std::string(row_of(format).name) + ": " + error.what());
  }
}

int64_t count_clamped(const Image& image, double exposure_stops, ImageFormat format) {
  const double scale = format == ImageFormat::exr ? elementary::exp2(exposure_stops) : 1.0;
  return std::count_if(image.rgb.begin(), image.rgb.end(),
                       [scale](float v) { return !(std::abs(v * scale) <= kLargestFloat); });
}

std::string clamped_warning(int64_t count, ImageFormat format) {
  const std::string values = std::to_string(count) + (count == 1 ? " value" : " values");
  if (format == ImageFormat::exr)
    return values +
           " of the picture cannot be held by a 32-bit float after exposure and became the nearest that can, " +
           "3.4e38 at most; a lower exposure keeps them";
  return values + " of the picture are not finite; +infinity is shown as white, all else as black";
}

Result<Rgb8Image> decode_image(std::string_view bytes, ImageFormat format, int64_t max_pixels) {
  if (format == ImageFormat::exr) {
    return decode_linear(bytes, format, max_pixels).map([](const Image& image) {
      return Rgb8Image{image.width, image.height, to_srgb8(image, 0.0)};
    });
  }
  auto open = open_input(bytes, format, max_pixels);
  if (!open) return ::tl::unexpected(open.error());
  auto rgb = read_rgb<uint8_t>(*open, OIIO::TypeUInt8);
  if (!rgb) return ::tl::unexpected(rgb.error());
  return Rgb8Image{open->spec.width, open->spec.height, std::move(*rgb)};
}

Result<Image> decode_linear(std::string_view bytes, ImageFormat format, int64_t max_pixels) {
  auto open = open_input(bytes, format, max_pixels);
  if (!open) return ::tl::unexpected(open.error());
  auto rgb = read_rgb<float>(*open, OIIO::TypeFloat);
  if (!rgb) return ::tl::unexpected(rgb.error());
  if (format != ImageFormat::exr)
    for (float& value : *rgb) value = static_cast<float>(linear_from_srgb(value));
  return Image{open->spec.width, open->spec.height, std::move(*rgb)};
}

}  // namespace tilelight
