// SPDX-License-Identifier: Apache-2.0
// Which facets of a closed mesh are wound inside out: cubes whose right winding is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderer/geometry/shells.h"

namespace tilelight {
namespace {

// Adds a cube of edge 2 * half; from_outside: wound outwards.
void add_cube(MeshData& mesh, const Vec3& middle, double half, bool from_outside = true) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back(middle + half * Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
  constexpr uint32_t kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& f : kFaces) {
    for (const auto& t : {std::array{f[0], f[1], f[2]}, std::array{f[0], f[2], f[3]}}) {
      const auto [a, b, c] = t;
      for (const uint32_t v : {a, from_outside ? b : c, from_outside ? c : b}) mesh.indices.push_back(first + v);
    }
  }
}

// How many facets of each cube, 12 triangles a time, are found to be inside out.
std::vector<int> turned_by_cube(const MeshData& data) {
  const TriMesh mesh = make_tri_mesh(data);
  EXPECT_TRUE(mesh.closed);
  const std::vector<bool> is_turned = find_inside_out(mesh, find_shells(mesh));
  std::vector<int> counts(mesh.triangles.size() / 12, 0);
  for (size_t t = 0; t < is_turned.size(); ++t) counts[t / 12] += is_turned[t];
  return counts;
}

struct Cube {
  Vec3 middle;
  double half;
  bool from_outside;
};
std::vector<int> turned_of(const std::vector<Cube>& cubes) {
  MeshData data;
  for (const Cube& cube : cubes) add_cube(data, cube.middle, cube.half, cube.from_outside);
  return turned_by_cube(data);
}

TEST(Shells, OfACubeWoundInwardsAreTurnedAtAnySizeAndPlace) {
  for (const double size : {1e-100, 1e-6, 1.0, 1e6, 1e100}) {
    EXPECT_EQ(turned_of({{Vec3(0.0), size, true}}), std::vector{0}) << size;
    EXPECT_EQ(turned_of({{Vec3(0.0), size, false}}), std::vector{12}) << size;
    EXPECT_EQ(turned_of({{size * Vec3(1e7, -3e6, 2e7), size, true}}), std::vector{0}) << size;
    EXPECT_EQ(turned_of({{size * Vec3(1e7, -3e6, 2e7), size, false}}), std::vector{12}) << size;
  }
}

TEST(Shells, ApartFromEachOtherAreTurnedEachByItself) {
  const Vec3 left(-3, 0, 0), right(3, 0, 0);
  EXPECT_EQ(turned_of({{left, 1, true}, {right, 1, true}}), (std::vector{0, 0}));
  EXPECT_EQ(turned_of({{left, 1, false}, {right, 0.5, true}}), (std::vector{12, 0}));
  EXPECT_EQ(turned_of({{left, 0.5, false}, {right, 1, true}}), (std::vector{12, 0}));
  EXPECT_EQ(turned_of({{left, 1, false}, {right, 1, false}}), (std::vector{12, 12}));
}

TEST(Shells, ThatAreCavitiesStay) {
  const Vec3 o(0.0);
  EXPECT_EQ(turned_of({{o, 3, true}, {o, 2, false}}), (std::vector{0, 0}));    // hollow
  EXPECT_EQ(turned_of({{o, 2, false}, {o, 3, true}}), (std::vector{0, 0}));    // in any order
  EXPECT_EQ(turned_of({{o, 3, false}, {o, 2, true}}), (std::vector{12, 12}));  // hollow, inside out
  EXPECT_EQ(turned_of({{o, 3, true}, {o, 2, false}, {o, 1, true}}), (std::vector{0, 0, 0}));
  EXPECT_EQ(turned_of({{o, 3, true}, {o, 2, false}, {o, 1, false}}), (std::vector{0, 0, 12}));
  EXPECT_EQ(turned_of({{o, 3, true}, {Vec3(9, 0, 0), 1, false}, {o, 2, false}}), (std::vector{0, 12, 0}));
}

TEST(Shells, ThatTouchAreToldApart) {
  // In a corner; in an edge; in a face, where each alone is not closed and both are one.
  EXPECT_EQ(turned_of({{Vec3(0, 0, 0), 1, true}, {Vec3(2, 2, 2), 1, false}}), (std::vector{0, 12}));
  EXPECT_EQ(turned_of({{Vec3(0, 0, 0), 1, true}, {Vec3(2, 2, 0), 1, false}}), (std::vector{0, 12}));
  EXPECT_EQ(turned_of({{Vec3(0, 0, 0), 1, true}, {Vec3(2, 0, 0), 1, true}}), (std::vector{0, 0}));
  EXPECT_EQ(turned_of({{Vec3(0, 0, 0), 1, false}, {Vec3(2, 0, 0), 1, false}}), (std::vector{12, 12}));
}

// Every facet from its lowest corner on, in ascending order, after what is inside out was turned.
using Facet = std::array<std::array<double, 3>, 3>;
std::vector<Facet> facets_of(const std::vector<Cube>& cubes) {
  MeshData data;
  for (const Cube& cube : cubes) add_cube(data, cube.middle, cube.half, cube.from_outside);
  TriMesh mesh = make_tri_mesh(data);
  const std::vector<bool> is_turned = find_inside_out(mesh, find_shells(mesh));
  if (!is_turned.empty()) mesh = with_turned(mesh, is_turned);
  std::vector<Facet> facets;
  for (const auto& triangle : mesh.triangles) {
    Facet& facet = facets.emplace_back();
    for (size_t k = 0; k < 3; ++k) {
      const Vec3& p = mesh.positions[triangle[k]];
      facet[k] = {p.x, p.y, p.z};
    }
    std::rotate(facet.begin(), std::min_element(facet.begin(), facet.end()), facet.end());
  }
  std::sort(facets.begin(), facets.end());
  return facets;
}

// The face between two of them is there twice, wound the same way, and either copy may be the one that is turned.
TEST(Shells, OfCubesWithFacesInCommonAreTurnedWhereOneAloneIsInsideOut) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-2.0, 2.0}) {
      Vec3 next(0.0);
      next[axis] = side;
      std::vector<Cube> row = {{next, 1, true}, {Vec3(0.0), 1, true}, {-next, 1, true}};
      const auto right = facets_of(row);
      for (Cube& cube : row) {
        cube.from_outside = false;
        EXPECT_EQ(facets_of(row), right) << axis << side;
        cube.from_outside = true;
      }
      const std::vector<Cube> pair = {{Vec3(0.0), 1, true}, {next, 1, true}},
                              wrong = {{Vec3(0.0), 1, true}, {next, 1, false}};
      EXPECT_EQ(facets_of(wrong), facets_of(pair)) << axis << side;
    }
  }
  std::vector<Cube> four = {{{-1, -1, 0}, 1, true}, {{1, -1, 0}, 1, true}, {{1, 1, 0}, 1, true}, {{-1, 1, 0}, 1, true}};
  const auto right = facets_of(four);
  for (Cube& cube : four) {
    cube.from_outside = false;
    EXPECT_EQ(facets_of(four), right) << "around an edge";
    cube.from_outside = true;
  }
}

TEST(Shells, OfACubeWithAFacetAddedBothWaysAreTheCubeAndASheet) {
  for (size_t facet = 0; facet < 12; ++facet) {
    for (const bool from_outside : {true, false}) {
      MeshData data;
      add_cube(data, Vec3(0.0), 1.0, from_outside);
      const std::array corner = {data.indices[3 * facet], data.indices[3 * facet + 1], data.indices[3 * facet + 2]};
      data.indices.insert(data.indices.end(), {corner[0], corner[1], corner[2], corner[2], corner[1], corner[0]});
      const TriMesh mesh = make_tri_mesh(data);
      ASSERT_TRUE(mesh.closed);
      Shells shells = find_shells(mesh);
      std::sort(shells.volume.begin(), shells.volume.end(),
                [](double a, double b) { return std::abs(a) > std::abs(b); });
      ASSERT_EQ(shells.volume.size(), 2u);
      EXPECT_EQ(shells.volume[0] > 0.0, from_outside);
      EXPECT_EQ(shells.volume[1], 0.0);
    }
  }
}

TEST(Shells, OfACubeThatIsThereTwiceAreTwoCubes) {
  EXPECT_EQ(turned_of({{Vec3(0.0), 1, true}, {Vec3(0.0), 1, true}}), (std::vector{0, 0}));
  EXPECT_EQ(turned_of({{Vec3(0.0), 1, false}, {Vec3(0.0), 1, false}}), (std::vector{12, 12}));
}

TEST(Shells, OfASheetWithABackHoldNoVolume) {
  MeshData data;
  data.positions = {{0, 0, 0}, {1, 0, 0.1}, {0, 1, 0.2}};
  data.indices = {0, 1, 2, 0, 2, 1};
  const TriMesh mesh = make_tri_mesh(data);
  ASSERT_TRUE(mesh.closed);
  EXPECT_FALSE(holds_volume(find_shells(mesh)));
  EXPECT_TRUE(find_inside_out(mesh, find_shells(mesh)).empty());
}

// More than are looked at one by one, every other one a cavity: none is turned, for all are wound as they should be.
TEST(Shells, ByTheThousandInsideEachOtherStay) {
  MeshData data;
  for (int i = 0; i < 3000; ++i) add_cube(data, Vec3(0.0), 1.0 + 0.001 * (3000 - i), i % 2 == 0);
  EXPECT_EQ(turned_by_cube(data), std::vector(3000, 0));
}

TEST(Shells, TurnedKeepPlacesAndNormals) {
  MeshData data;
  add_cube(data, Vec3(0.0), 1.0, false);
  data.crease_deg = 180.0;
  const TriMesh mesh = make_tri_mesh(data);
  const TriMesh turned = with_turned(mesh, find_inside_out(mesh, find_shells(mesh)));
  EXPECT_EQ(turned.positions, mesh.positions);
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    EXPECT_EQ(turned.triangles[t], (std::array{mesh.triangles[t][2], mesh.triangles[t][1], mesh.triangles[t][0]}));
    EXPECT_EQ(turned.corner_normals[t][0], mesh.corner_normals[t][2]);
  }
  EXPECT_TRUE(find_inside_out(turned, find_shells(turned)).empty());
}

}  // namespace
}  // namespace tilelight
