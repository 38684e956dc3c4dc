// SPDX-License-Identifier: Apache-2.0
// JPEG files of 8-bit sRGB pictures, by libjpeg under an error handler of ours. OpenImageIO 2.4 leaves the library's
// own in place when it writes, and that ends the process. Any thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/base/result.h"

namespace tilelight {

inline constexpr int kMaxJpegSide = 65'500;  // pixels; the library's JPEG_MAX_DIMENSION

// rgb: width * height * 3 bytes, row by row from the top. The same picture gives the same bytes.
// Errors: encode_failed, with the library's reason.
Result<std::string> write_jpeg(int width, int height, const std::vector<uint8_t>& rgb);

}  // namespace tilelight
