// SPDX-License-Identifier: Apache-2.0
// A: flat shapes before black, seen at right angles, one unit a pixel: what each pixel should show is the area of the
// shape in it.
#include "renderer/check/rows/accuracy.h"

#include <cmath>

#include "renderer/base/elementary.h"
#include "renderer/check/kit/rays.h"
#include "renderer/film/tone.h"

namespace tilelight::check {
namespace {

struct Point {
  double x, y;
};
using Polygon = std::vector<Point>;

// Every point p with normal . p <= offset.
struct HalfPlane {
  Point normal;
  double offset;
  double over(const Point& p) const { return normal.x * p.x + normal.y * p.y - offset; }
};

// Sutherland and Hodgman 1974.
Polygon clip(const Polygon& polygon, const HalfPlane& half) {
  Polygon out;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double over_a = half.over(a), over_b = half.over(b);
    if (over_a <= 0.0) out.push_back(a);
    if ((over_a < 0.0 && over_b > 0.0) || (over_a > 0.0 && over_b < 0.0)) {
      const double t = over_a / (over_a - over_b);
      out.push_back({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)});
    }
  }
  return out;
}

double area(const Polygon& polygon) {
  double twice = 0.0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x * b.y - b.x * a.y;
  }
  return 0.5 * std::abs(twice);
}

// A strip of the plane through the image's middle, or as much of it as lies left of its axis.
struct Strip {
  double angle, width, shift;  // rad, pixels, pixels
  Point along() const { return {elementary::cos(angle), elementary::sin(angle)}; }
  Point across() const { return {-elementary::sin(angle), elementary::cos(angle)}; }
};

constexpr double kFar = 500.0;  // beyond any image here, pixels

// By pixel, row by row from the top: the part of it that the strip covers.
std::vector<double> coverages(const Strip& strip, int size) {
  const Point n = strip.across();
  const HalfPlane upper{n, strip.shift + strip.width}, lower{{-n.x, -n.y}, -strip.shift};
  std::vector<double> out;
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const double x = column - 0.5 * size, y = 0.5 * size - row - 1.0;
      out.push_back(area(clip(clip({{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}}, upper), lower)));
    }
  }
  return out;
}

// Ambient light shows the strip as 1 before `background`, both linear.
std::string strip_json(const Strip& strip, int size, const std::string& render, double background = 0.0) {
  const Point a = strip.along(), n = strip.across();
  std::string positions;
  for (const auto& [s, t] : {std::pair{-kFar, 0.0}, {kFar, 0.0}, {kFar, strip.width}, {-kFar, strip.width}}) {
    const double out = strip.shift + t;
    positions += (positions.empty() ? "" : ", ") + text(s * a.x + out * n.x) + ", " + text(s * a.y + out * n.y) + ", 0";
  }
  return "{" + image_text(size, size) + R"(, "render": {)" + render + R"(}, "camera": {"type": "orthographic",
    "position": [0, 0, 10], "target": [0, 0, 0], "height": )" +
         text(size) + R"(}, "lights": [], "ambient": 1,
    "background": {"bottom": )" +
         text(background) + R"(, "top": )" + text(background) + R"(}, "meshes": {"strip": {"positions": [)" +
         positions +
         R"(], "indices": [0, 1, 2, 0, 2, 3]}}, "objects": [{"type": "mesh", "mesh": "strip", "material":
    {"ambient": 1, "diffuse": 0}}]})";
}

Strip random_edge(Random& random) {
  return {random.between(0.0, 2.0 * elementary::kPi), kFar, random.between(-0.5, 0.5)};
}

double slope(double at_few, double at_many, double octaves) { return elementary::log2(at_many / at_few) / octaves; }

struct EdgeErrors {
  double rmse = 0.0, random = 0.0;  // of the pixels that the edge crosses; of as many random samples
};
EdgeErrors edge_errors(const Context& context, int samples) {
  const int size = 32, edges = context.is_quick ? 8 : 40;
  Random random(41);
  double squares = 0.0, variance = 0.0;
  int64_t count = 0;
  for (int i = 0; i < edges; ++i) {
    const Strip edge = random_edge(random);
    const std::vector<double> want = coverages(edge, size);
    const Picture picture = picture_of(
        scene_of(strip_json(edge, size, R"("samples": )" + text(samples) + R"(, "seed": )" + text(i))), context.pool);
    for (size_t p = 0; p < want.size(); ++p) {
      if (want[p] <= 0.0 || want[p] >= 1.0) continue;
      const double error = picture.linear[3 * p] - want[p];
      squares += error * error;
      variance += want[p] * (1.0 - want[p]) / samples;
      ++count;
    }
  }
  return {std::sqrt(squares / static_cast<double>(count)), std::sqrt(variance / static_cast<double>(count))};
}

// A plane under a near light: kd I (h / rho) / (rho + K), whose mean over a pixel a Gauss-Legendre rule gives.
double smooth_error(const Context& context, int samples) {
  constexpr int kSize = 16;
  constexpr double kHeight = 6.0, kK = 2.0;
  const Picture picture = picture_of(
      scene_of("{" + image_text(kSize, kSize) + R"(, "render": {"samples": )" + text(samples) + R"(}, "camera":
        {"type": "orthographic", "position": [0, 0, 3], "target": [0, 0, 0], "height": )" +
               text(kSize) + R"(}, "ambient": 0, "attenuation": {"mode": "linear", "k": )" + text(kK) +
               R"(}, "lights": [{"type": "point", "position": [0.3, 0.2, )" + text(kHeight) +
               R"(], "intensity": 8}], "objects": [{"type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1],
                 "material": {"ambient": 0, "diffuse": 1}}]})"),
      context.pool);
  constexpr std::array<double, 4> kNodes{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                         0.8611363115940526};
  constexpr std::array<double, 4> kWeights{0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                           0.3478548451374538};
  double squares = 0.0;
  for (int p = 0; p < kSize * kSize; ++p) {
    double mean = 0.0;
    for (size_t i = 0; i < 4; ++i) {
      for (size_t j = 0; j < 4; ++j) {
        const double x = p % kSize - 0.5 * kSize + 0.5 + 0.5 * kNodes[i] - 0.3;
        const double y = 0.5 * kSize - p / kSize - 0.5 + 0.5 * kNodes[j] - 0.2;
        const double rho = std::sqrt(x * x + y * y + kHeight * kHeight);
        mean += 0.25 * kWeights[i] * kWeights[j] * 8.0 * (kHeight / rho) / (rho + kK);
      }
    }
    const double error = picture.linear[3 * static_cast<size_t>(p)] - mean;
    squares += error * error;
  }
  return std::sqrt(squares / (kSize * kSize));
}

Outcome convergence(const Context& context) {
  const EdgeErrors at4 = edge_errors(context, 4), at16 = edge_errors(context, 16), at64 = edge_errors(context, 64),
                   at256 = edge_errors(context, 256), at1024 = edge_errors(context, 1024);
  return {
      {at_most(0.050, "edges, 16 samples: rmse", at16.rmse), at_most(0.018, "edges, 64 samples: rmse", at64.rmse),
       at_most(0.0065, "edges, 256 samples: rmse", at256.rmse),
       at_most(-0.70, "edges, 4 to 1024 samples: slope", slope(at4.rmse, at1024.rmse, 8.0)),
       at_least(3.0, "edges, 64 samples: random's rmse over ours", at64.random / at64.rmse),
       at_most(-1.3, "smooth, 4 to 256 samples: slope",
               slope(smooth_error(context, 4), smooth_error(context, 256), 6.0))},
      {at_most(0.050, "edges, 16 samples: rmse", at16.random), at_most(0.018, "edges, 64 samples: rmse", at64.random),
       at_most(-0.70, "edges, 4 to 1024 samples: slope", slope(at4.random, at1024.random, 8.0))}};
}

// What is told of shapes that most samples miss; and of pixels that look flat and are not.
struct Told {
  double real = 0.0, told = 0.0;  // sums of squares
  int64_t partly = 0, falsely_flat = 0, naive_flat = 0;
};

void take(Told& sum, const Context& context, const Strip& strip, const std::string& render, double least_coverage,
          double background = 0.0) {
  const int size = 64;
  const std::vector<double> want = coverages(strip, size);
  const Picture picture = picture_of(scene_of(strip_json(strip, size, render, background)), context.pool);
  const Picture naive = picture_of(scene_of(strip_json(strip, size, R"("samples": 4)")), context.pool);
  double squares = 0.0;
  for (size_t p = 0; p < want.size(); ++p) {
    const double error =
        std::abs(displayed(picture.linear[3 * p], 0.0) - displayed(background + (1.0 - background) * want[p], 0.0));
    squares += error * error;
    if (std::min(want[p], 1.0 - want[p]) < least_coverage) continue;
    const auto is_flat = [p, background](const Picture& of) {
      return of.linear[3 * p] <= background || of.linear[3 * p] == 1.0f;
    };
    ++sum.partly;
    sum.falsely_flat += is_flat(picture) && error > picture.error_bounds[p];
    sum.naive_flat += is_flat(naive);
  }
  const double told = picture.report.points.back().error.rmse;
  sum.real += squares / static_cast<double>(want.size());
  sum.told += told * told;
}

Outcome thin_and_small(const Context& context) {
  const int count = context.is_quick ? 8 : 40;
  Random random(43);
  Told wires, adaptive_wires, edges, faint;
  for (int i = 0; i < count; ++i) {
    const std::string seed = R"(, "seed": )" + text(i);
    const Strip wire{random.between(0.0, elementary::kPi), 0.01, random.between(-9.0, 9.0)};
    take(wires, context, wire, R"("samples": 64)" + seed, 0.004);
    take(adaptive_wires, context, wire, R"("samples": 32, "adaptive": true)" + seed, 0.004, 0.2);
    const Strip edge = random_edge(random);
    take(edges, context, edge, R"("rmse": 0.004)" + seed, 0.10);
    take(faint, context, edge, R"("rmse": 0.004)" + seed, 0.02);
  }
  const auto over = [](const Told& sum) { return std::sqrt(sum.real / sum.told); };
  return {
      {at_most(1.2, "wires of 0.01 pixels, 64 samples: true rmse over the one told", over(wires)),
       at_most(1.2, "the same, 32 adaptive samples", over(adaptive_wires)),
       at_most(0.5, "flat by mistake, of pixels covered by 10 % or more, %", percent(edges.falsely_flat, edges.partly)),
       at_most(1.0, "flat by mistake, of pixels covered by 2 % or more, %", percent(faint.falsely_flat, faint.partly))},
      {at_most(0.5, "flat by mistake, of pixels covered by 10 % or more, %", percent(edges.naive_flat, edges.partly))}};
}

constexpr Row kRows[] = {
    {"A1", "convergence", "edges and slopes, 4 to 1024 samples", "independent random samples", convergence},
    {"A2", "thin and small", "wires of 0.01 pixels; edges that few samples meet", "flat if four samples agree",
     thin_and_small},
    {"A3", "the error told by pixel", "random scenes, asked for an rmse of 0.02 and 0.005", "", told_by_pixel},
    {"A4", "checker to the horizon", "cells far below a pixel", "a regular grid of samples", checker_to_the_horizon},
    {"A5", "asked for, and reached", "200 random scenes, an rmse of 0.01", "", asked_and_reached},
};

}  // namespace

std::span<const Row> accuracy_rows() { return kRows; }

}  // namespace tilelight::check
