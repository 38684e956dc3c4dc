// SPDX-License-Identifier: Apache-2.0
// L: lights and distances over many decades.
#include <algorithm>

#include "renderer/base/elementary.h"
#include "renderer/check/rows/lights.h"

namespace tilelight::check {

// Lights straight above, their intensities a geometric series over 30 decades, strong ones first and last. The sum of
// the series is known, and half a last place of the film's float is all that may be lost.
Outcome many_decades(const Context& context) {
  constexpr int kLights = 1000;
  constexpr double kFilmRounding = 0x1p-24;
  const double log_ratio = elementary::log(1e30) / (kLights - 1);
  const auto intensity = [&](int i) { return 1e-15 * elementary::exp(i * log_ratio); };
  std::string rising, falling;
  float naive_rising = 0.0f, naive_falling = 0.0f;
  for (int i = 0; i < kLights; ++i) {
    const auto light = [&](int of) {
      return (i ? ", " : "") + std::string(R"({"type": "directional", "direction": [0, 0, -1], "intensity": )") +
             text(intensity(of)) + "}";
    };
    rising += light(i), falling += light(kLights - 1 - i);
    naive_rising += static_cast<float>(intensity(i)), naive_falling += static_cast<float>(intensity(kLights - 1 - i));
  }
  const auto lit_by = [&](const std::string& lights) {
    return picture_of(scene_of("{" + view_along_z(4, 1.0, 1) + dark_but(lights) + R"("objects": [
        {"type": "box", "min": [-1, -1, -1], "max": [1, 1, 0], "material": {"diffuse": 1, "ambient": 0}}]})"),
                      context.pool)
        .linear[0];
  };
  const double sum = 1e-15 * elementary::expm1(kLights * log_ratio) / elementary::expm1(log_ratio);
  const double worst = std::max(relative(lit_by(rising), sum), relative(lit_by(falling), sum));
  const double naive_worst = std::max(relative(naive_rising, sum), relative(naive_falling, sum));
  return {{at_most(kFilmRounding, "sum in either order, relative error", worst)},
          {at_most(kFilmRounding, "sum in float, relative error", naive_worst)}};
}

// I = d^2 at the distance d: kd, wherever the light stands.
Outcome inverse_square(const Context& context) {
  double worst = 0.0, naive_worst = 0.0;
  for (int exponent = -12; exponent <= 12; exponent += context.is_quick ? 4 : 1) {
    const double d = elementary::exp(exponent * elementary::log(10.0));
    // All rays start at x = z = 0.5: what their pixels add is under its last bit.
    const Picture picture = picture_of(
        scene_of(R"({"camera": {"type": "orthographic", "height": 1e-20, "up": [0, 0, -1], "position": [0.5, 5, 0.5],
          "target": [0.5, 0, 0.5]}, "image": {"width": 4, "height": 4},
          "attenuation": {"mode": "inverse_square", "k": 0}, )" +
                 dark_but(R"({"type": "point", "position": [0.5, )" + text(d) + R"(, 0.5], "intensity": )" +
                          text(d * d) + "}") +
                 R"("objects": [{"type": "plane", "material": {"diffuse": 0.8, "ambient": 0}}]})"),
        context.pool);
    note(worst, relative(picture.linear[0], 0.8));
    note(naive_worst, relative(0.8 * d * d / std::max(d * d, 1e-4), 0.8));
  }
  return {{at_most(1e-6, "kd I / d^2, relative error", worst)},
          {at_most(1e-6, "kd I / max(d^2, 1e-4), relative error", naive_worst)}};
}

}  // namespace tilelight::check
