// SPDX-License-Identifier: Apache-2.0
// The film's blocks of samples, and the error that they tell of integrals whose truth is known.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>

#include "renderer/film/error_map.h"
#include "renderer/film/sampling.h"
#include "renderer/film/tone.h"

namespace tilelight {
namespace {

using Shade = std::function<float(double x, double y)>;  // image coordinates, pixels -> grey, linear

void take(Film& film, const TileRect& rect, uint32_t last, uint32_t seed, const Shade& shade) {
  film.grow(last);
  TileView view = film.view();
  for_each_cell(rect, [&](const TileRect& cell) {
    uint32_t& taken = film.samples()[film.cell_at(cell.x0, cell.y0)];
    for (uint32_t i = taken; i < last; ++i) {
      for_each_pixel(cell, [&](int x, int y) {
        const SamplePoint p = sample_point(x, y, seed, i);
        const float grey = shade(x + p.x, y + p.y);
        const float rgb[] = {grey, grey, grey};
        view.add(x, y, 1, i, rgb);
      });
    }
    taken = std::max(taken, last);
  });
}

TileRect all_of(const Film& film) { return {0, 0, film.width(), film.height()}; }

Image resolved(const Film& film) {
  Image image{film.width(), film.height(), std::vector<float>(static_cast<size_t>(film.width()) * film.height() * 3)};
  film.resolve(all_of(film), image);
  return image;
}

ErrorMap map_of(const Film& film, const Image& image) {
  ErrorMap map(film.width(), film.height(), 0.0);
  map.measure(film, image, all_of(film));
  map.pool(film);
  map.spread(film, all_of(film));
  return map;
}

TEST(Film, ResolvesToTheMeanOfItsSamplesPixelByPixel) {
  for (const uint32_t count : {1u, 2u, 7u, 8u, 9u, 16u, 37u, 100u, 128u}) {
    Film film(5, 3);
    film.fill_black(count);
    TileView view = film.view();
    // Whole numbers: every sum is exact.
    for (uint32_t i = 0; i < count; ++i) {
      const float rgb[] = {static_cast<float>(i), 10.0f * static_cast<float>(i), 1.0f};
      view.add(4, 2, 1, i, rgb);
    }
    const Image image = resolved(film);
    const float mean = 0.5f * static_cast<float>(count - 1);
    const size_t at = (2 * 5 + 4) * 3;
    EXPECT_EQ(image.rgb[at], mean);
    EXPECT_EQ(image.rgb[at + 1], 10.0f * mean);
    EXPECT_EQ(image.rgb[at + 2], 1.0f);
    EXPECT_EQ(std::accumulate(image.rgb.begin(), image.rgb.end(), 0.0f), 11.0f * mean + 1.0f);
  }
}

TEST(Film, HoldsTheSameBitsHoweverItsSamplesWereSplit) {
  const Shade shade = [](double x, double y) { return static_cast<float>(std::sin(3.0 * x * y) + 1.0); };
  Film at_once(9, 6), in_parts(9, 6);
  take(at_once, {0, 0, 9, 6}, 100, 1, shade);
  for (const uint32_t last : {1u, 2u, 5u, 8u, 9u, 31u, 64u, 99u, 100u}) take(in_parts, {0, 0, 9, 6}, last, 1, shade);
  EXPECT_EQ(resolved(at_once).rgb, resolved(in_parts).rgb);
}

TEST(Film, HoldsWhatItsCellsHaveTaken) {
  Film film(9, 6);
  take(film, {0, 0, 9, 6}, 2, 1, [](double, double) { return 0.5f; });
  take(film, {4, 0, 8, 4}, 64, 1, [](double, double) { return 1.0f; });
  const Image image = resolved(film);
  for_each_pixel({0, 0, 9, 6}, [&](int x, int y) {
    const bool is_in_cell = x >= 4 && x < 8 && y < 4;
    EXPECT_EQ(image.rgb[(static_cast<size_t>(y) * 9 + x) * 3], is_in_cell ? 63.0f / 64.0f : 0.5f);
  });
}

TEST(ErrorMap, KnowsNothingOfASingleSampleAndTheTruthOfAConstant) {
  Film film(8, 8);
  take(film, all_of(film), 1, 0, [](double, double) { return 0.25f; });
  EXPECT_FALSE(map_of(film, resolved(film)).summary().is_known);
  take(film, all_of(film), 16, 0, [](double, double) { return 0.25f; });
  const ErrorSummary summary = map_of(film, resolved(film)).summary();
  EXPECT_TRUE(summary.is_known);
  EXPECT_EQ(summary.rmse, 0.0);
  EXPECT_EQ(summary.most, 0.0);
  EXPECT_EQ(summary.unconverged, 0);
}

TEST(ErrorMap, BoundsASingleSampleByWhatItsNeighboursShow) {
  for (const auto& [width, height] : {std::pair(1, 1), {2, 1}, {1, 5}, {5, 3}, {37, 9}, {70, 41}}) {
    Film film(width, height);
    // Bytes of the display, so that rounding to them loses nothing.
    const auto byte_at = [](int x, int y) { return (37 * x + 101 * y + x * y * y) % 256; };
    take(film, all_of(film), 1, 1, [&](double x, double y) {
      return static_cast<float>(linear_from_srgb(byte_at(static_cast<int>(x), static_cast<int>(y)) / 255.0));
    });
    const std::vector<float> bounds = map_of(film, resolved(film)).bounds();
    for_each_pixel(all_of(film), [&](int x, int y) {
      double sum = 0.0;
      int count = 0;
      for_each_pixel({std::max(0, x - 1), std::max(0, y - 1), std::min(width, x + 2), std::min(height, y + 2)},
                     [&](int u, int v) {
                       sum += std::pow((byte_at(u, v) - byte_at(x, y)) / 255.0, 2.0);
                       count += u != x || v != y;
                     });
      const double contrast = count > 0 ? std::sqrt(sum / count) : 0.0;
      ASSERT_NEAR(bounds[static_cast<size_t>(y) * width + x], 1.96 * contrast, 1e-6) << width << " " << x << "," << y;
    });
  }
}

TEST(ErrorMap, SaysTheSameHoweverTheImageIsCut) {
  const Shade shade = [](double x, double y) { return static_cast<float>(0.5 + 0.5 * std::sin(0.003 * x * y)); };
  Film first(131, 70), second(131, 70);
  take(first, all_of(first), 4, 1, shade);
  take(second, all_of(second), 4, 1, shade);
  take(second, {0, 0, 60, 40}, 8, 1, shade);
  take(second, {32, 16, 44, 28}, 40, 1, shade);
  const auto told = [&](int edge) {
    ErrorMap map(first.width(), first.height(), 0.0);
    const int tiles = tile_count(first.width(), first.height(), edge);
    const auto part = [&](int i) { return tile_rect(i, first.width(), first.height(), edge); };
    for (const Film* film : {&first, &second}) {
      const Image image = resolved(*film);
      for (int i = 0; i < tiles; ++i) map.measure(*film, image, part(i));
      map.pool(*film);
      for (int i = tiles; i-- > 0;) map.spread(*film, part(i));
    }
    return map;
  };
  const ErrorMap whole = told(1000);
  for (const int edge : {4, 12, 32, 100}) {
    const ErrorMap cut = told(edge);
    EXPECT_EQ(cut.bounds(), whole.bounds()) << edge;
    EXPECT_EQ(cut.cell_variances(), whole.cell_variances()) << edge;
    EXPECT_EQ(cut.summary().rmse, whole.summary().rmse) << edge;
  }
}

// Powers of two change no digit of light, so the same picture is shown; squares of such light no float holds.
TEST(ErrorMap, TellsTheSameOfLightAsBrightAsItsExposureIsDark) {
  const auto told = [](int stops, double least) {
    Film film(40, 40);
    take(film, all_of(film), 13, 1, [&](double x, double y) {
      return static_cast<float>(std::ldexp(std::hypot(x - 20.0, y - 17.0) < 9.3 ? 0.8 : least, stops));
    });
    ErrorMap map(40, 40, -stops);
    map.measure(film, resolved(film), all_of(film));
    map.pool(film);
    map.spread(film, all_of(film));
    return map;
  };
  const ErrorMap plain = told(0, 0.1);
  EXPECT_GT(plain.summary().rmse, 0.005);
  for (const int stops : {-100, -70, 60, 95}) {
    const ErrorMap same = told(stops, 0.1);
    EXPECT_EQ(same.summary().rmse, plain.summary().rmse) << stops;
    EXPECT_EQ(same.bounds(), plain.bounds()) << stops;
  }
}

// A pixel that an edge of blinding light crosses is white or black, and the light as bright as it may be.
TEST(ErrorMap, TellsAFiniteErrorOfBlindingLight) {
  const auto told = [](double light) {
    Film film(40, 40);
    take(film, all_of(film), 16, 1,
         [&](double x, double y) { return static_cast<float>(x + 0.3 * y < 21.7 ? light : 0.0); });
    return map_of(film, resolved(film)).summary().rmse;
  };
  const double bright = told(1e9);
  EXPECT_GT(bright, 1e-3);
  for (const double light : {1e17, 1e21, 1e25, 9e33}) {
    EXPECT_GT(told(light), 0.5 * bright) << light;
    EXPECT_LT(told(light), 2.0 * bright) << light;
  }
}

// Where all is clamped to white, whatever is wrong does not show.
TEST(ErrorMap, CountsWhatIsDisplayed) {
  const Shade lines = [](double x, double) { return std::fmod(x, 1.0) < 0.3 ? 2.0f : 8.0f; };
  Film film(16, 16);
  take(film, all_of(film), 16, 0, lines);
  EXPECT_EQ(map_of(film, resolved(film)).summary().rmse, 0.0);
  ErrorMap darker(16, 16, -6.0);
  darker.measure(film, resolved(film), all_of(film));
  darker.pool(film);
  EXPECT_GT(darker.summary().rmse, 1e-3);
}

// A scene whose pixels' means are known: a disc of one grey on another, by the area of its part in each pixel, and a
// smooth wave, by its integral.
struct Truth {
  const char* name;
  Shade shade;
  std::function<double(int x, int y)> mean;  // linear
};

constexpr int kSize = 64;
constexpr double kRadius = 20.3, kCenter = 32.1;

double half_chord(double x) { return std::sqrt(std::max(0.0, kRadius * kRadius - x * x)); }

// By a fine sum over columns of what is exact in y.
double disc_in_pixel(int x, int y) {
  constexpr int kColumns = 4000;
  double area = 0.0;
  for (int i = 0; i < kColumns; ++i) {
    const double half = half_chord(x + (i + 0.5) / kColumns - kCenter);
    area += std::max(0.0, std::min(y + 1.0, kCenter + half) - std::max<double>(y, kCenter - half)) / kColumns;
  }
  return area;
}

std::vector<Truth> truths() {
  return {{"disc", [](double x, double y) { return std::hypot(x - kCenter, y - kCenter) < kRadius ? 0.9f : 0.1f; },
           [](int x, int y) { return 0.1 + 0.8 * disc_in_pixel(x, y); }},
          {"wave", [](double x, double y) { return static_cast<float>(0.5 + 0.2 * std::sin(x) + 0.2 * std::cos(y)); },
           [](int x, int y) {
             return 0.5 + 0.2 * (std::cos(x) - std::cos(x + 1)) + 0.2 * (std::sin(y + 1) - std::sin(y));
           }}};
}

// The picture's estimate is near to the truth, and its upper end above it; and so are 95 % of the pixels' bounds.
TEST(ErrorMap, TellsTheErrorOfWhatIsKnownInClosedForm) {
  for (const Truth& truth : truths()) {
    std::vector<double> want;
    for_each_pixel({0, 0, kSize, kSize}, [&](int x, int y) { want.push_back(displayed(truth.mean(x, y), 0.0)); });
    for (const uint32_t count : {8u, 16u, 40u, 64u}) {
      int held = 0, pictures = 0;
      double covered = 0.0, told = 0.0, real = 0.0;
      for (uint32_t seed = 0; seed < 20; ++seed, ++pictures) {
        Film film(kSize, kSize);
        take(film, all_of(film), count, seed, truth.shade);
        const Image image = resolved(film);
        const ErrorMap map = map_of(film, image);
        const std::vector<float> bounds = map.bounds();
        double sum = 0.0;
        for (size_t i = 0; i < want.size(); ++i) {
          const double error = std::abs(displayed(image.rgb[3 * i], 0.0) - want[i]);
          sum += error * error;
          covered += error <= bounds[i] + 1e-6;
        }
        const double rmse = std::sqrt(sum / static_cast<double>(want.size()));
        const ErrorSummary summary = map.summary();
        held += rmse <= summary.high;
        told += summary.rmse, real += rmse;
      }
      EXPECT_GT(told / real, 0.9) << truth.name << " " << count;
      EXPECT_LT(told / real, 1.35) << truth.name << " " << count;
      EXPECT_GE(held, 19) << truth.name << " " << count;
      EXPECT_GE(covered / (static_cast<double>(want.size()) * pictures), 0.95) << truth.name << " " << count;
    }
  }
}

}  // namespace
}  // namespace tilelight
