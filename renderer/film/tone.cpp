// SPDX-License-Identifier: Apache-2.0
#include "renderer/film/tone.h"

#include <algorithm>
#include <array>
#include <bit>

#include "renderer/base/elementary.h"
#include "renderer/base/standard_floats.h"

namespace tilelight {
namespace {

// Of a displayed value in [0, 1], rounded half up.
int byte_of(double shown) { return static_cast<int>(255.0 * shown + 0.5); }

// NaN fails the comparison and becomes 0.
double clamp01(double v) { return v > 0.0 ? std::min(v, 1.0) : 0.0; }

// byte_of(srgb_from_linear(v)) without a power: by the upper bits of v the byte at the start of its bucket, then one
// comparison, because no bucket holds two thresholds (the curve rises by less than 80 bytes an octave, and an octave
// has 256 buckets). 720p takes milliseconds instead of 0.2 s, with the same bytes.
class ByteTable {
 public:
  ByteTable() {
    thresholds_[0] = 0.0;
    for (int k = 1; k < 256; ++k) thresholds_[k] = find_threshold(k);
    thresholds_[256] = 2.0;  // no clamped value reaches it
    first_ = bucket(thresholds_[1]);
    for (int64_t b = first_; b <= bucket(1.0); ++b) {
      const double start = std::bit_cast<double>(static_cast<uint64_t>(b) << kShift);
      const auto above = std::upper_bound(thresholds_.begin() + 1, thresholds_.begin() + 256, start);
      byte_at_start_.push_back(static_cast<uint8_t>(above - thresholds_.begin() - 1));
    }
  }

  // REQUIRES: v in [0, 1].
  uint8_t operator()(double v) const {
    const uint8_t byte = byte_at_start_[static_cast<size_t>(std::max<int64_t>(bucket(v) - first_, 0))];
    return byte + static_cast<uint8_t>(v >= thresholds_[byte + 1]);
  }

 private:
  static constexpr int kShift = 52 - 8;
  static int64_t bucket(double v) { return static_cast<int64_t>(std::bit_cast<uint64_t>(v) >> kShift); }

  // The least double that shows as byte k: positive doubles are ordered as their bits.
  static double find_threshold(int k) {
    uint64_t below = 0, reached = std::bit_cast<uint64_t>(1.0);
    while (reached - below > 1) {
      const uint64_t middle = below + (reached - below) / 2;
      (byte_of(srgb_from_linear(std::bit_cast<double>(middle))) >= k ? reached : below) = middle;
    }
    return std::bit_cast<double>(reached);
  }

  std::array<double, 257> thresholds_;
  std::vector<uint8_t> byte_at_start_;
  int64_t first_ = 0;
};

}  // namespace

double srgb_from_linear(double linear) {
  if (linear <= 0.0031308) return 12.92 * linear;
  return 1.0 + 1.055 * (elementary::pow(linear, 1.0 / 2.4) - 1.0);  // 1.055 p - 0.055, and 1 gives 1
}

double linear_from_srgb(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : elementary::pow((srgb + 0.055) / 1.055, 2.4);
}

double displayed(double linear, double exposure_stops) {
  return srgb_from_linear(clamp01(linear * elementary::exp2(exposure_stops)));
}

std::vector<uint8_t> to_srgb8(const Image& image, double exposure_stops) {
  const StandardFloats floats;
  static const ByteTable table;
  const double scale = elementary::exp2(exposure_stops);
  std::vector<uint8_t> bytes(image.rgb.size());
  std::transform(image.rgb.begin(), image.rgb.end(), bytes.begin(),
                 [scale](float linear) { return table(clamp01(linear * scale)); });
  return bytes;
}

}  // namespace tilelight
