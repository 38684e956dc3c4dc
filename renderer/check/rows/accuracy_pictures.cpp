// SPDX-License-Identifier: Apache-2.0
// A: whole pictures of scenes that nobody has tuned anything on, beside the same with many times the samples and
// another seed.
#include <algorithm>
#include <cmath>
#include <complex>

#include "renderer/base/elementary.h"
#include "renderer/check/kit/random_scene.h"
#include "renderer/check/rows/accuracy.h"
#include "renderer/film/tone.h"

namespace tilelight::check {
namespace {

std::string render_text(int width, int height, const std::string& rules, uint64_t seed) {
  return image_text(width, height) + R"(, "render": {"seed": )" + text(static_cast<double>(seed)) + ", " + rules +
         "}, ";
}

constexpr uint64_t kReferenceSeed = 4'000'000'000;

// Scene number `index`.
Picture random_picture(const Context& context, uint64_t index, int width, int height, const std::string& rules,
                       uint64_t seed) {
  Random random(1000 + index);
  return picture_of(scene_of(random_scene_json(random, render_text(width, height, rules, seed))), context.pool);
}

std::vector<double> shown(const Picture& picture) {
  std::vector<double> out;
  out.reserve(picture.linear.size());
  for (const float v : picture.linear) out.push_back(displayed(v, 0.0));
  return out;
}

// Of a pixel: root mean square over its channels.
double error_at(const std::vector<double>& a, const std::vector<double>& b, size_t pixel) {
  double sum = 0.0;
  for (size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / 3.0);
}

double rmse(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

struct Coverage {
  int64_t noisy = 0, noisy_held = 0, all = 0, all_held = 0;
  double widths = 0.0, ideal_widths = 0.0;
};

void take_scene(Coverage& sum, const Context& context, uint64_t index, const std::string& rules, int seeds) {
  const int width = context.is_quick ? 48 : 96, height = width * 3 / 4;
  const Picture reference = random_picture(context, index, width, height, R"("samples": 512)", kReferenceSeed);
  const std::vector<double> truth = shown(reference);
  const size_t pixels = truth.size() / 3;
  std::vector<double> squares(pixels), bounds(pixels);
  std::vector<int> held(pixels);
  for (int seed = 0; seed < seeds; ++seed) {
    const Picture picture = random_picture(context, index, width, height, rules, static_cast<uint64_t>(seed));
    const std::vector<double> values = shown(picture);
    for (size_t p = 0; p < pixels; ++p) {
      const double error = error_at(values, truth, p), bound = picture.error_bounds[p];
      squares[p] += error * error;
      bounds[p] += bound;
      // What float rounds off a sum, and what the reference is off itself, is no error of the bound's.
      held[p] += error <= bound + 1e-6;
    }
  }
  for (size_t p = 0; p < pixels; ++p) {
    sum.all += seeds, sum.all_held += held[p];
    if (!(reference.error_bounds[p] > 1e-7f)) continue;
    sum.noisy += seeds, sum.noisy_held += held[p];
    sum.widths += bounds[p] / seeds;
    sum.ideal_widths += 1.96 * std::sqrt(squares[p] / seeds);
  }
}

}  // namespace

Outcome told_by_pixel(const Context& context) {
  const uint64_t scenes = context.is_quick ? 3 : 10;
  const int seeds = context.is_quick ? 3 : 4;
  Coverage sum;
  for (uint64_t index = 0; index < scenes; ++index) {
    for (const char* rules : {R"("rmse": 0.02)", R"("rmse": 0.005)"}) take_scene(sum, context, index, rules, seeds);
  }
  return {{at_least(93.0, "bounds that hold, of pixels that are not constant, %", percent(sum.noisy_held, sum.noisy)),
           at_least(95.0, "bounds that hold, of all pixels, %", percent(sum.all_held, sum.all)),
           at_most(2.5, "bounds over ideal ones, mean", sum.widths / sum.ideal_widths)},
          {}};
}

Outcome asked_and_reached(const Context& context) {
  const uint64_t scenes = context.is_quick ? 20 : 200;
  constexpr double kAsked = 0.01;
  int64_t reached = 0;
  std::vector<double> told;  // over the true one
  for (uint64_t index = 0; index < scenes; ++index) {
    const auto picture = [&](const std::string& rules, uint64_t seed) {
      return random_picture(context, 500 + index, 40, 30, rules, seed);
    };
    const Picture ours = picture(R"("rmse": )" + text(kAsked), 1);
    const double real = rmse(shown(ours), shown(picture(R"("samples": 256)", kReferenceSeed)));
    reached += real <= kAsked;
    told.push_back(ours.report.points.back().error.rmse / real);
  }
  std::nth_element(told.begin(), told.begin() + static_cast<int64_t>(told.size() / 2), told.end());
  const double middle = told[told.size() / 2];
  return {{at_least(95.0, "pictures whose true rmse is as asked, %", percent(reached, static_cast<int64_t>(scenes))),
           at_most(1.3, "rmse told over the true one, median", middle),
           at_least(0.9, "rmse told over the true one, median", middle)},
          {}};
}

Outcome checker_to_the_horizon(const Context& context) {
  // Rows under the horizon in which a cell of the floor is smaller than a quarter of a pixel. The camera looks level:
  // the row y pixels under the middle sees the floor at height * focal / y.
  constexpr int kSize = 128;
  constexpr double kCell = 0.02, kEye = 1.0, kFov = 40.0;
  const double focal = 0.5 * kSize / elementary::tan(elementary::rad_from_deg(0.5 * kFov));
  const int samples = context.is_quick ? 64 : 256;
  const Picture picture = picture_of(
      scene_of("{" + image_text(kSize, kSize) + R"(, "render": {"samples": )" + text(samples) +
               R"(}, "camera": {"position": [0.3, 1, 0], "target": [0.3, 1, -5], "fov_y_deg": 40}, "lights": [],
                 "ambient": 1, "objects": [{"type": "plane", "point": [0, 0, 0], "material": {"diffuse": 0,
                 "ambient": {"checker": {"a": 1, "b": 0, "size": )" +
               text(kCell) + R"(}}}}]})"),
      context.pool);
  // Peak over root mean square of the amplitudes of all waves along the rows, and the mean.
  struct Waves {
    double mean = 0.0, peak = 0.0;
  };
  const auto waves = [&](const auto& value_at) {
    Waves out;
    double power = 0.0, peak = 0.0;
    int64_t count = 0, rows = 0;
    for (int row = kSize / 2; row < kSize; ++row) {
      const double under = row + 1.0 - 0.5 * kSize;  // of the row's lower edge
      const double cell_px = kCell * under / kEye;   // of a cell across
      if (cell_px > 0.25) break;
      ++rows;
      for (int k = 1; k < kSize / 2; ++k) {
        std::complex<double> sum = 0.0;
        for (int x = 0; x < kSize; ++x) {
          const double phase = 2.0 * elementary::kPi * ((k * x) % kSize) / kSize;
          sum += (value_at(x, row) - 0.5) * std::complex(elementary::cos(phase), elementary::sin(phase));
        }
        power += std::norm(sum), peak = std::max(peak, std::norm(sum));
        ++count;
      }
      for (int x = 0; x < kSize; ++x) out.mean += value_at(x, row) / kSize;
    }
    out.mean /= static_cast<double>(rows);
    out.peak = std::sqrt(peak / std::max(1e-300, power / static_cast<double>(count)));
    return out;
  };
  const Waves ours = waves([&](int x, int y) { return picture.linear[3 * (static_cast<size_t>(y) * kSize + x)]; });
  // A regular grid of 16 by 16 samples a pixel.
  const Waves grid = waves([&](int x, int y) {
    constexpr int kSide = 16;
    int light = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
      const double u = x + (i % kSide + 0.5) / kSide - 0.5 * kSize, v = y + (i / kSide + 0.5) / kSide - 0.5 * kSize;
      const double far = kEye * focal / v, aside = 0.3 + kEye * u / v;
      light +=
          (static_cast<int64_t>(std::floor(aside / kCell)) + static_cast<int64_t>(std::floor(-far / kCell))) % 2 == 0;
    }
    return static_cast<double>(light) / (kSide * kSide);
  });
  return {{at_most(0.01, "mean near the horizon, off 0.5 by", std::abs(ours.mean - 0.5)),
           at_most(5.0, "largest wave over the root mean square of all", ours.peak)},
          {at_most(5.0, "largest wave over the root mean square of all", grid.peak)}};
}

}  // namespace tilelight::check
