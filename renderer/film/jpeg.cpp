// SPDX-License-Identifier: Apache-2.0
#include "renderer/film/jpeg.h"

#include <csetjmp>
#include <cstddef>
#include <cstdio>  // before the library's header, which needs it
#include <cstdlib>

#include <jerror.h>
#include <jpeglib.h>

namespace tilelight {
namespace {

static_assert(kMaxJpegSide == JPEG_MAX_DIMENSION);

constexpr int kQuality = 92;
constexpr size_t kFirstBytes = size_t{64} << 10;

// Everything that a compression holds, outside the frame that a jump goes back to. The library's structures come first
// in ours, so that its pointers to them are pointers to these.
struct Errors {
  jpeg_error_mgr base;
  std::jmp_buf back;
  char reason[JMSG_LENGTH_MAX];
};
struct Output {
  jpeg_destination_mgr base;
  JOCTET* bytes;
  size_t capacity, size;
};
struct Compression {
  Compression() = default;
  Compression(const Compression&) = delete;
  Compression& operator=(const Compression&) = delete;
  ~Compression() {
    jpeg_destroy_compress(&info);
    std::free(out.bytes);
  }

  jpeg_compress_struct info = {};
  Errors errors = {};
  Output out = {};
};

[[noreturn]] void go_back(j_common_ptr info) {
  auto* const errors = reinterpret_cast<Errors*>(info->err);
  errors->base.format_message(info, errors->reason);
  std::longjmp(errors->back, 1);
}

void stay_silent(j_common_ptr) {}  // the library's own prints warnings on standard error

// Makes the output twice as large; what was written stays.
boolean grow(j_compress_ptr info) {
  auto* const out = reinterpret_cast<Output*>(info->dest);
  const size_t capacity = out->capacity == 0 ? kFirstBytes : 2 * out->capacity;
  auto* const bytes = static_cast<JOCTET*>(std::realloc(out->bytes, capacity));
  if (!bytes) ERREXIT1(info, JERR_OUT_OF_MEMORY, 0);
  out->base.next_output_byte = bytes + out->capacity;
  out->base.free_in_buffer = capacity - out->capacity;
  out->bytes = bytes;
  out->capacity = capacity;
  return TRUE;
}

void begin_output(j_compress_ptr info) { grow(info); }

void end_output(j_compress_ptr info) {
  auto* const out = reinterpret_cast<Output*>(info->dest);
  out->size = out->capacity - out->base.free_in_buffer;
}

// False: errors.reason says why not. Nothing with a destructor may live in this frame: a jump would pass over it.
bool compress(Compression& c, int width, int height, const uint8_t* rgb) {
  c.info.err = jpeg_std_error(&c.errors.base);
  c.errors.base.error_exit = go_back;
  c.errors.base.output_message = stay_silent;
  if (setjmp(c.errors.back) != 0) return false;
  jpeg_create_compress(&c.info);
  c.out.base = {nullptr, 0, begin_output, grow, end_output};
  c.info.dest = &c.out.base;
  c.info.image_width = static_cast<JDIMENSION>(width);
  c.info.image_height = static_cast<JDIMENSION>(height);
  c.info.input_components = 3;
  c.info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&c.info);
  jpeg_set_quality(&c.info, kQuality, TRUE);
  jpeg_start_compress(&c.info, TRUE);
  const size_t row_bytes = 3 * static_cast<size_t>(width);
  while (c.info.next_scanline < c.info.image_height) {
    auto* row = const_cast<JSAMPROW>(rgb + c.info.next_scanline * row_bytes);  // which the library only reads
    jpeg_write_scanlines(&c.info, &row, 1);
  }
  jpeg_finish_compress(&c.info);
  return true;
}

}  // namespace

Result<std::string> write_jpeg(int width, int height, const std::vector<uint8_t>& rgb) {
  Compression compression;
  if (!compress(compression, width, height, rgb.data()))
    return fail("encode_failed", std::string("writing a JPEG: ") + compression.errors.reason);
  return std::string(reinterpret_cast<const char*>(compression.out.bytes), compression.out.size);
}

}  // namespace tilelight
