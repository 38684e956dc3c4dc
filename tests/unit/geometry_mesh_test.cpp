// SPDX-License-Identifier: Apache-2.0
// User meshes: what is dropped, how normals are made, when a mesh counts as closed.
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/geometry/tri_mesh.h"

namespace tilelight {
namespace {

MeshData cube(double crease_deg) {
  MeshData data;
  for (int i = 0; i < 8; ++i) data.positions.push_back(Vec3(i & 1, i >> 1 & 1, i >> 2 & 1) * 2.0 - Vec3(1.0));
  data.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                  2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  data.crease_deg = crease_deg;
  return data;
}

// An icosahedron whose triangles are quartered `levels` times, on the unit sphere. Edges share no vertices: every
// triangle brings its own, so welding has to find them.
MeshData icosphere(int levels) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  const std::vector<Vec3> p{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                            {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  const std::vector<int> faces{0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                               4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                               6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
  std::vector<Vec3> soup;
  for (int i : faces) soup.push_back(glm::normalize(p[i]));
  for (int level = 0; level < levels; ++level) {
    std::vector<Vec3> finer;
    for (size_t i = 0; i < soup.size(); i += 3) {
      const Vec3 a = soup[i], b = soup[i + 1], c = soup[i + 2];
      // The sum does not depend on the order of its terms, so both sides of an edge get the same bits.
      const Vec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
      for (const Vec3& v : {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca}) finer.push_back(v);
    }
    soup = finer;
  }
  MeshData data;
  data.positions = soup;
  for (uint32_t i = 0; i < soup.size(); ++i) data.indices.push_back(i);
  return data;
}

TEST(UserMesh, ACubeStaysSharpAtThirtyDegrees) {
  const TriMesh mesh = make_tri_mesh(cube(30.0));
  ASSERT_EQ(mesh.triangles.size(), 12u);
  EXPECT_TRUE(mesh.closed);
  EXPECT_TRUE(mesh.corner_normals.empty());  // none but the facets' own
}

TEST(UserMesh, ACubesCornersPointAlongTheDiagonalsWhenEveryEdgeIsSmooth) {
  for (const double crease : {90.0, 180.0}) {
    const TriMesh mesh = make_tri_mesh(cube(crease));
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
      for (size_t k = 0; k < 3; ++k) {
        // Weighed by angle, the three faces count alike however their squares are cut in two.
        const Vec3 diagonal = mesh.positions[mesh.triangles[t][k]] / std::sqrt(3.0);
        EXPECT_LT(glm::length(mesh.corner_normals[t][k] - diagonal), 1e-14) << "crease " << crease;
      }
  }
}

TEST(UserMesh, NormalsOfAnIcosphereAreTheSpheresOwn) {
  const TriMesh mesh = make_tri_mesh(icosphere(3));
  EXPECT_EQ(mesh.triangles.size(), 1280u);
  EXPECT_EQ(mesh.positions.size(), 642u);  // V = 10 * 4^3 + 2
  EXPECT_TRUE(mesh.closed);
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    for (size_t k = 0; k < 3; ++k)
      EXPECT_GT(glm::dot(mesh.corner_normals[t][k], mesh.positions[mesh.triangles[t][k]]), 0.9999);
}

TEST(UserMesh, TrianglesWithoutAreaAreDroppedAndCounted) {
  MeshData data = cube(30.0);
  const TriMesh clean = make_tri_mesh(data);
  data.positions.push_back({0.1, 0.1, 0.1});
  data.positions.push_back({0.2, 0.2, 0.2});
  data.positions.push_back({0.3, 0.3, 0.3});
  data.positions.push_back(data.positions[0]);
  for (uint32_t i : {8u, 9u, 10u, 0u, 0u, 1u, 0u, 11u, 5u}) data.indices.push_back(i);
  const TriMesh mesh = make_tri_mesh(data);
  EXPECT_EQ(mesh.degenerate_dropped, 3);
  EXPECT_EQ(mesh.positions, clean.positions);
  EXPECT_EQ(mesh.triangles, clean.triangles);
  EXPECT_EQ(mesh.corner_normals, clean.corner_normals);
}

TEST(UserMesh, SliversOfAMillionToOneAndTinyMeshesAreKept) {
  MeshData sliver;
  sliver.positions = {{0, 0, 0}, {1, 0, 0}, {0.5, 1e-6, 0}};
  sliver.indices = {0, 1, 2};
  EXPECT_EQ(make_tri_mesh(sliver).triangles.size(), 1u);
  for (const double scale : {1e-12, 1e-150, 1e150}) {
    MeshData data = cube(30.0);
    for (Vec3& p : data.positions) p *= scale;
    const TriMesh mesh = make_tri_mesh(data);
    EXPECT_EQ(mesh.degenerate_dropped, 0) << scale;
    EXPECT_EQ(mesh.corner_normals, make_tri_mesh(cube(30.0)).corner_normals) << scale;
  }
}

TEST(UserMesh, GivenNormalsAreNormalisedAndZeroOnesTakeTheFacets) {
  MeshData data;
  data.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  data.indices = {0, 1, 2};
  data.normals = {{0, 3, 4}, {0, 0, 0}, {0, 0, 1e-300}};
  const TriMesh mesh = make_tri_mesh(data);
  EXPECT_EQ(mesh.normals_repaired, 1);
  EXPECT_LT(glm::length(mesh.corner_normals[0][0] - Vec3(0, 0.6, 0.8)), 1e-15);
  EXPECT_EQ(mesh.corner_normals[0][1], Vec3(0, 0, 1));
  EXPECT_EQ(mesh.corner_normals[0][2], Vec3(0, 0, 1));
}

TEST(UserMesh, AnOpenAndAFlippedMeshAreNotClosedADoubledOneIs) {
  MeshData open = cube(30.0);
  open.indices.resize(33);
  EXPECT_FALSE(make_tri_mesh(open).closed);
  MeshData flipped = cube(30.0);
  std::swap(flipped.indices[0], flipped.indices[1]);
  EXPECT_FALSE(make_tri_mesh(flipped).closed);
  MeshData doubled = cube(30.0);
  const std::vector<uint32_t> once = doubled.indices;
  doubled.indices.insert(doubled.indices.end(), once.begin(), once.end());
  EXPECT_TRUE(make_tri_mesh(doubled).closed);
  EXPECT_FALSE(make_tri_mesh(doubled).is_manifold);
}

TEST(UserMesh, AFoldedSheetsOppositeFacetsDoNotAverageToNothing) {
  MeshData data;  // the same triangle from both sides
  data.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  data.indices = {0, 1, 2, 0, 2, 1};
  data.crease_deg = 180.0;
  const TriMesh mesh = make_tri_mesh(data);
  EXPECT_EQ(mesh.normals_repaired, 6);
  EXPECT_TRUE(mesh.corner_normals.empty());  // flat: each facet has its own
}

}  // namespace
}  // namespace tilelight
