// SPDX-License-Identifier: Apache-2.0
#include "renderer/film/heat_map.h"

#include <array>

#include "renderer/base/elementary.h"
#include "renderer/film/tone.h"

namespace tilelight {
namespace {

// A ramp of rising brightness, sRGB.
constexpr std::array<std::array<double, 3>, 6> kRamp{{{0.00, 0.00, 0.02},
                                                      {0.26, 0.07, 0.45},
                                                      {0.70, 0.16, 0.36},
                                                      {0.94, 0.42, 0.16},
                                                      {0.99, 0.75, 0.20},
                                                      {1.00, 1.00, 0.78}}};
constexpr double kDarkest = 0.25 / 255.0, kBrightest = 64.0 / 255.0;
constexpr int kShades = 1024;

// By shade: linear RGB.
std::array<std::array<float, 3>, kShades + 1> make_shades() {
  std::array<std::array<float, 3>, kShades + 1> out;
  for (int i = 0; i <= kShades; ++i) {
    const double at = static_cast<double>(i) * (kRamp.size() - 1) / kShades;
    const size_t below = std::min(static_cast<size_t>(at), kRamp.size() - 2);
    for (size_t c = 0; c < 3; ++c) {
      const double srgb = kRamp[below][c] + (at - static_cast<double>(below)) * (kRamp[below + 1][c] - kRamp[below][c]);
      out[static_cast<size_t>(i)][c] = static_cast<float>(linear_from_srgb(srgb));
    }
  }
  return out;
}

size_t shade_of(double bound) {
  if (!(bound > kDarkest)) return 0;
  static const double octaves = elementary::log2(kBrightest / kDarkest);
  return static_cast<size_t>(kShades * std::min(1.0, elementary::log2(bound / kDarkest) / octaves));
}

}  // namespace

Image error_image(int width, int height, const std::vector<float>& bounds) {
  Image out{width, height, {}};
  out.rgb.reserve(bounds.size() * 3);
  for (const float bound : bounds) out.rgb.insert(out.rgb.end(), 3, bound);
  return out;
}

Image heat_map(int width, int height, const std::vector<float>& bounds) {
  static const auto shades = make_shades();
  Image out{width, height, {}};
  out.rgb.reserve(bounds.size() * 3);
  for (const float bound : bounds) {
    const auto& shade = shades[shade_of(bound)];
    out.rgb.insert(out.rgb.end(), shade.begin(), shade.end());
  }
  return out;
}

}  // namespace tilelight
