// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "renderer/film/sampling.h"

namespace tilelight {
namespace {

std::vector<SamplePoint> points(int x, int y, uint32_t seed, uint32_t first, uint32_t count) {
  std::vector<SamplePoint> list;
  for (uint32_t i = 0; i < count; ++i) list.push_back(sample_point(x, y, seed, first + i));
  return list;
}

// Niederreiter's (0, m, 2)-net in base 2: every box of 2^-a by 2^-(m-a) holds exactly one of the 2^m points.
bool is_net(const std::vector<SamplePoint>& list, int m) {
  for (int a = 0; a <= m; ++a) {
    std::set<std::pair<int, int>> boxes;
    for (const SamplePoint& p : list)
      boxes.insert({static_cast<int>(std::ldexp(p.x, a)), static_cast<int>(std::ldexp(p.y, m - a))});
    if (boxes.size() != list.size()) return false;
  }
  return true;
}

TEST(Sampling, EveryAlignedPowerOfTwoBlockIsStratifiedInEveryElementaryInterval) {
  for (int m = 0; m <= 10; ++m)
    for (uint32_t block : {0u, 1u, 2u, 3u, 7u, 1000u})
      for (int pixel = 0; pixel < 4; ++pixel)
        ASSERT_TRUE(is_net(points(17 * pixel, 5 * pixel, 9, block << m, 1u << m), m)) << m << " " << block;
}

TEST(Sampling, PointsLieInsideThePixelAndDependOnPixelSeedAndIndex) {
  std::set<std::pair<double, double>> seen;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      for (uint32_t seed : {0u, 1u})
        for (uint32_t i = 0; i < 16; ++i) {
          const SamplePoint p = sample_point(x, y, seed, i);
          ASSERT_TRUE(p.x >= 0.0 && p.x < 1.0 && p.y >= 0.0 && p.y < 1.0);
          seen.insert({p.x, p.y});
        }
  EXPECT_EQ(seen.size(), 8u * 8 * 2 * 16);
}

TEST(Sampling, EachPointAloneIsUniformOverThePixels) {
  for (uint32_t index : {0u, 1u, 5u, 63u}) {
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    constexpr int kSide = 300;
    for (int i = 0; i < kSide * kSide; ++i) {
      const SamplePoint p = sample_point(i % kSide, i / kSide, 3, index);
      x += p.x, y += p.y, xx += p.x * p.x, xy += p.x * p.y;
    }
    constexpr double kCount = kSide * kSide;  // five standard deviations of a mean: 5 * 0.29 / 300
    EXPECT_NEAR(x / kCount, 1.0 / 2.0, 0.005);
    EXPECT_NEAR(y / kCount, 1.0 / 2.0, 0.005);
    EXPECT_NEAR(xx / kCount, 1.0 / 3.0, 0.005);
    EXPECT_NEAR(xy / kCount, 1.0 / 4.0, 0.005);
  }
}

// The share of the unit square in the half plane nx*x + ny*y <= d, in closed form: by inclusion and exclusion of
// corners.
double half_plane_area(double nx, double ny, double d) {
  auto corner = [&](double x, double y) { return std::pow(std::max(0.0, d - nx * x - ny * y), 2.0); };
  return (corner(0, 0) - corner(1, 0) - corner(0, 1) + corner(1, 1)) / (2.0 * nx * ny);
}

double half_plane_rmse(uint32_t count) {
  constexpr int kEdges = 4000;
  double square = 0.0;
  for (int e = 0; e < kEdges; ++e) {
    const SamplePoint random = sample_point(e, -1, 77, 0);
    const double angle = (0.01 + 0.98 * random.x) * std::acos(0.0);
    const double nx = std::cos(angle), ny = std::sin(angle), d = random.y * (nx + ny);
    int inside = 0;
    for (const SamplePoint& p : points(e, 0, 5, 0, count)) inside += nx * p.x + ny * p.y <= d;
    square += std::pow(static_cast<double>(inside) / count - half_plane_area(nx, ny, d), 2.0);
  }
  return std::sqrt(square / kEdges);
}

// Row A1 of the stress catalogue: an edge's error falls as n^-0.75, where random points give n^-0.5.
TEST(Sampling, ErrorOfARandomEdgeFallsWithSlopeThreeQuarters) {
  const double at16 = half_plane_rmse(16), at64 = half_plane_rmse(64), at256 = half_plane_rmse(256);
  EXPECT_LE(at16, 0.05);
  EXPECT_LE(at64, 0.018);
  EXPECT_LE(at256, 0.0065);
  EXPECT_LE(std::log2(half_plane_rmse(1024) / half_plane_rmse(4)) / 8.0, -0.70);
  RecordProperty("rmse16", std::to_string(at16));
}

}  // namespace
}  // namespace tilelight
