// SPDX-License-Identifier: Apache-2.0
// Which meshes touch themselves: prisms of a known outline, with every choice of diagonals, at any size and place.
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/geometry/self_touch.h"
#include "renderer/geometry/shells.h"

namespace tilelight {
namespace {

using Outline = std::vector<Vec3>;  // counter-clockwise, in the plane z = 0
using Caps = std::vector<uint32_t>;

// From z = -1 to 1. Bit i of `diagonals`: how the i-th wall, of the first 32, is cut into two.
MeshData prism(const Outline& outline, const Caps& cap, unsigned diagonals = 0) {
  MeshData mesh;
  const auto n = static_cast<uint32_t>(outline.size());
  for (const double z : {-1.0, 1.0})
    for (const Vec3& p : outline) mesh.positions.emplace_back(p.x, p.y, z);
  const auto add = [&](uint32_t a, uint32_t b, uint32_t c) { mesh.indices.insert(mesh.indices.end(), {a, b, c}); };
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t k = (i + 1) % n;
    if (i < 32 && (diagonals >> i & 1)) {
      add(i, k, n + k), add(i, n + k, n + i);
    } else {
      add(i, k, n + i), add(k, n + k, n + i);
    }
  }
  for (size_t i = 0; i < cap.size(); i += 3) {
    add(cap[i], cap[i + 2], cap[i + 1]);
    add(n + cap[i], n + cap[i + 1], n + cap[i + 2]);
  }
  return mesh;
}

// A block, and the same with a slit of this height from the right; without one its walls lie on each other.
MeshData slit(double height, unsigned diagonals) {
  const Outline outline = {{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {2, 2, 0}, {4.5, 2 + height, 0}, {4.5, 4, 0}, {0, 4, 0}};
  return prism(outline, {0, 1, 3, 1, 2, 3, 0, 3, 6, 3, 4, 6, 4, 5, 6}, diagonals);
}

bool touches(MeshData data, const Mat3& turn, double size, const Vec3& middle) {
  for (Vec3& p : data.positions) p = size * (turn * p) + middle;
  const TriMesh mesh = make_tri_mesh(data);
  EXPECT_TRUE(mesh.is_manifold);
  EXPECT_EQ(find_shells(mesh).volume.size(), 1u);
  return touches_itself(mesh);
}

TEST(MeshesThatTouchThemselves, AreThoseOfASlitWithoutWidthHoweverItsWallsAreCut) {
  const double c = std::cos(0.7), s = std::sin(0.7);
  const Mat3 turned = Mat3(c, s, 0, -s, c, 0, 0, 0, 1) * Mat3(1, 0, 0, 0, c, s, 0, -s, c);
  for (unsigned diagonals = 0; diagonals < 128; ++diagonals) {
    for (const Mat3& turn : {Mat3(1.0), turned}) {
      for (const double size : {1e-30, 1.0, 1e30}) {
        EXPECT_TRUE(touches(slit(0.0, diagonals), turn, size, Vec3(0.0))) << diagonals;
        EXPECT_FALSE(touches(slit(0.01, diagonals), turn, size, Vec3(0.0))) << diagonals;
      }
      EXPECT_TRUE(touches(slit(0.0, diagonals), turn, 1.0, Vec3(1e6, -3e6, 2e6))) << diagonals;
      EXPECT_FALSE(touches(slit(0.01, diagonals), turn, 1.0, Vec3(1e6, -3e6, 2e6))) << diagonals;
    }
  }
}

// Neighbours of a flat or nearly flat surface lie in one plane, but beside each other.
TEST(MeshesThatTouchThemselves, AreNotThoseWhoseNeighboursLieInOnePlane) {
  for (const double size : {1e-30, 1.0, 1e30})
    EXPECT_FALSE(
        touches(prism({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}, {0, 1, 2, 0, 2, 3}), Mat3(1.0), size, Vec3(0.0)));
  Outline disc;
  Caps fan;
  for (uint32_t i = 0; i < 500; ++i) {
    disc.emplace_back(std::cos(6.283185307179586 * i / 500), std::sin(6.283185307179586 * i / 500), 0.0);
    if (i > 1) fan.insert(fan.end(), {0, i - 1, i});
  }
  EXPECT_FALSE(touches(prism(disc, fan), Mat3(1.0), 1.0, Vec3(0.0)));
}

}  // namespace
}  // namespace tilelight
