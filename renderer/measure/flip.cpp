// SPDX-License-Identifier: Apache-2.0
#include "renderer/measure/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "renderer/base/elementary.h"
#include "renderer/base/vec.h"
#include "renderer/film/tone.h"
#include "renderer/measure/planes.h"

namespace tilelight {
namespace {

using elementary::exp;
using elementary::pow;

// sRGB primaries; columns are red, green and blue. White is (1, 1, 1) in RGB.
const glm::dmat3 kXyzFromRgb(0.4124564, 0.2126729, 0.0193339, 0.3575761, 0.7151522, 0.1191920, 0.1804375, 0.0721750,
                             0.9503041);
const Vec3 kWhite = kXyzFromRgb * Vec3(1.0);

// Luminance and two opponent colours, linear in light.
Vec3 opponent_of(const Vec3& rgb) {
  const Vec3 xyz = kXyzFromRgb * rgb / kWhite;
  return {116.0 * xyz.y - 16.0, 500.0 * (xyz.x - xyz.y), 200.0 * (xyz.y - xyz.z)};
}

Vec3 rgb_from_opponent(const Vec3& c) {
  static const glm::dmat3 rgb_from_xyz = glm::inverse(kXyzFromRgb);
  const double y = (c.x + 16.0) / 116.0;
  return rgb_from_xyz * (Vec3(y + c.y / 500.0, y, y - c.z / 200.0) * kWhite);
}

// CIELAB with its colours dimmed where it is dark (Hunt).
Vec3 hunt_lab_of(const Vec3& rgb) {
  const Vec3 xyz = kXyzFromRgb * rgb / kWhite;
  const auto f = [](double t) {
    constexpr double kDelta = 6.0 / 29.0;
    return t > kDelta * kDelta * kDelta ? pow(t, 1.0 / 3.0) : t / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
  };
  const Vec3 g{f(xyz.x), f(xyz.y), f(xyz.z)};
  const double lightness = 116.0 * g.y - 16.0;
  return {lightness, 0.01 * lightness * 500.0 * (g.x - g.y), 0.01 * lightness * 200.0 * (g.y - g.z)};
}

// The distance that holds for large differences of colour.
double hyab(const Vec3& a, const Vec3& b) {
  const Vec3 d = a - b;
  return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

// A sum of two Gaussians of the distance in degrees: how well the eye follows contrast.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr std::array<Sensitivity, 3> kEye{{{1.0, 0.0047, 0.0, 1e-5},     // luminance
                                           {1.0, 0.0053, 0.0, 1e-5},     // red and green
                                           {34.1, 0.04, 13.5, 0.025}}};  // blue and yellow
constexpr double kPi2 = elementary::kPi * elementary::kPi;

Plane as_the_eye_blurs(const Plane& plane, const Sensitivity& eye, double pixels_per_degree, int reach) {
  Plane out = plane;
  std::fill(out.values.begin(), out.values.end(), 0.0);
  double total = 0.0;
  for (const auto& [a, b] : {std::pair(eye.a1, eye.b1), std::pair(eye.a2, eye.b2)}) {
    if (a == 0.0) continue;
    Taps taps;
    for (int i = -reach; i <= reach; ++i) {
      const double degrees = i / pixels_per_degree;
      taps.push_back(exp(-kPi2 * degrees * degrees / b));
    }
    const double height = a * std::sqrt(elementary::kPi / b), sum = std::accumulate(taps.begin(), taps.end(), 0.0);
    const Plane blurred = convolved(plane, taps, taps);
    for (size_t i = 0; i < out.values.size(); ++i) out.values[i] += height * blurred.values[i];
    total += height * sum * sum;
  }
  for (double& v : out.values) v /= total;
  return out;
}

std::vector<Vec3> linear_of(const DisplayedImage& image) {
  std::vector<Vec3> out(image.rgb.size() / 3);
  for (size_t i = 0; i < out.size(); ++i) {
    for (int c = 0; c < 3; ++c)
      out[i][c] = linear_from_srgb(std::clamp<double>(image.rgb[3 * i + static_cast<size_t>(c)], 0.0, 1.0));
  }
  return out;
}

// Colours as they are seen from the distance, dimmed CIELAB.
std::vector<Vec3> seen_colors(const DisplayedImage& image, const std::vector<Vec3>& linear, double pixels_per_degree) {
  double widest = 0.0;
  for (const Sensitivity& eye : kEye) widest = std::max({widest, eye.b1, eye.b2});
  const int reach = static_cast<int>(std::ceil(3.0 * std::sqrt(widest / (2.0 * kPi2)) * pixels_per_degree));
  std::array<Plane, 3> planes;
  for (int c = 0; c < 3; ++c) {
    Plane& plane = planes[static_cast<size_t>(c)];
    plane = {image.width, image.height, std::vector<double>(linear.size())};
    for (size_t i = 0; i < linear.size(); ++i) plane.values[i] = opponent_of(linear[i])[c];
    plane = as_the_eye_blurs(plane, kEye[static_cast<size_t>(c)], pixels_per_degree, reach);
  }
  std::vector<Vec3> out(linear.size());
  for (size_t i = 0; i < out.size(); ++i) {
    const Vec3 rgb = rgb_from_opponent({planes[0].values[i], planes[1].values[i], planes[2].values[i]});
    out[i] = hunt_lab_of(glm::clamp(rgb, Vec3(0.0), Vec3(1.0)));
  }
  return out;
}

double color_difference(const Vec3& a, const Vec3& b) {
  constexpr double kExponent = 0.7, kKnee = 0.4, kKneeAt = 0.95;
  static const double most =
      pow(hyab(hunt_lab_of({0.0, 1.0, 0.0}), hunt_lab_of({0.0, 0.0, 1.0})), kExponent);  // green to blue
  const double d = pow(hyab(a, b), kExponent), knee = kKnee * most;
  return d < knee ? kKneeAt / knee * d : kKneeAt + (d - knee) / (most - knee) * (1.0 - kKneeAt);
}

// Positive and negative weights each sum to one.
void balance(Taps& taps) {
  double above = 0.0, below = 0.0;
  for (const double tap : taps) (tap > 0.0 ? above : below) += std::abs(tap);
  for (double& tap : taps) tap /= tap > 0.0 ? above : below;
}

struct Features {
  std::vector<double> edges, points;  // by pixel: how strong
};

Features features_of(const DisplayedImage& image, const std::vector<Vec3>& linear, double pixels_per_degree) {
  constexpr double kEdgeDegrees = 0.082;
  const double deviation = 0.5 * kEdgeDegrees * pixels_per_degree;
  const int reach = static_cast<int>(std::ceil(3.0 * deviation));
  Taps smooth, first, second;
  for (int i = -reach; i <= reach; ++i) {
    smooth.push_back(exp(-0.5 * i * i / (deviation * deviation)));
    first.push_back(-i * smooth.back());
    second.push_back((i * i / (deviation * deviation) - 1.0) * smooth.back());
  }
  balance(smooth), balance(first), balance(second);
  Plane luminance{image.width, image.height, std::vector<double>(linear.size())};
  for (size_t i = 0; i < linear.size(); ++i) luminance.values[i] = (opponent_of(linear[i]).x + 16.0) / 116.0;
  const auto strength = [&](const Taps& taps) {
    Plane along_x = convolved(luminance, taps, smooth);
    const Plane along_y = convolved(luminance, smooth, taps);
    for (size_t i = 0; i < linear.size(); ++i)
      along_x.values[i] = std::sqrt(along_x.values[i] * along_x.values[i] + along_y.values[i] * along_y.values[i]);
    return std::move(along_x.values);
  };
  return {strength(first), strength(second)};
}

}  // namespace

std::vector<double> flip_map(const DisplayedImage& tested, const DisplayedImage& truth, double pixels_per_degree) {
  const std::vector<Vec3> linear_a = linear_of(tested), linear_b = linear_of(truth);
  const std::vector<Vec3> color_a = seen_colors(tested, linear_a, pixels_per_degree);
  const std::vector<Vec3> color_b = seen_colors(truth, linear_b, pixels_per_degree);
  const Features a = features_of(tested, linear_a, pixels_per_degree);
  const Features b = features_of(truth, linear_b, pixels_per_degree);
  std::vector<double> out(color_a.size());
  for (size_t i = 0; i < out.size(); ++i) {
    const double feature = std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i]));
    const double strength = std::min(1.0, std::sqrt(feature / std::sqrt(2.0)));
    out[i] = pow(color_difference(color_a[i], color_b[i]), 1.0 - strength);
  }
  return out;
}

double mean_flip(const DisplayedImage& tested, const DisplayedImage& truth) {
  const std::vector<double> map = flip_map(tested, truth);
  return std::accumulate(map.begin(), map.end(), 0.0) / static_cast<double>(map.size());
}

}  // namespace tilelight
