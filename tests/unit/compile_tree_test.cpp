// SPDX-License-Identifier: Apache-2.0
// The trees that rays walk: they hold everything once, in boxes that hold it, and depend on nothing but the scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "renderer/compile/compile.h"
#include "renderer/compile/compiled_scene.h"

namespace tilelight {
namespace {

// Every box of the input lies in every box on the way to its leaf.
void expect_nested(const WideBvh& bvh, const std::vector<Box>& boxes, uint32_t node, std::vector<int>& seen) {
  for (int c = 0; c < WideBvh::kWidth; ++c) {
    const uint32_t child = bvh.nodes[node].child[c];
    if (child == WideBvh::kEmpty) continue;
    if (!(child & WideBvh::kLeafBit)) {
      expect_nested(bvh, boxes, child, seen);
      continue;
    }
    const WideBvh::Leaf leaf = bvh.leaves[child & ~WideBvh::kLeafBit];
    for (uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
      ++seen[bvh.order[i]];
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(bvh.nodes[node].bounds[0][axis][c], boxes[bvh.order[i]].lo[axis]);
        EXPECT_GE(bvh.nodes[node].bounds[1][axis][c], boxes[bvh.order[i]].hi[axis]);
      }
    }
  }
}

BoxSource source_of(const std::vector<Box>& boxes) {
  return {static_cast<uint32_t>(boxes.size()), [&boxes](uint32_t i) { return boxes[i]; }};
}

TEST(Trees, HoldEveryBoxOnceAlsoWhenAllAreEqual) {
  TilePool pool(2);
  std::vector<Box> spread, equal(100'000);
  for (int i = 0; i < 40'000; ++i) {
    Box box;
    const Vec3 p(std::fmod(i * 0.618, 2.0) - 1, std::fmod(i * 0.414, 2.0) - 1, std::fmod(i * 0.732, 2.0) - 1);
    box.grow(p);
    box.grow(p + Vec3(1e-3));
    spread.push_back(box);
  }
  for (Box& box : equal) box.grow(Vec3(0.25)), box.grow(Vec3(0.5));
  for (const auto* boxes : {&spread, &equal}) {
    const WideBvh bvh = build_bvh(source_of(*boxes), 8, pool);
    std::vector<int> seen(boxes->size());
    expect_nested(bvh, *boxes, 0, seen);
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<long>(boxes->size()));
    EXPECT_LE(bvh.depth, 64);
  }
}

template <class T>
bool is_same(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(Trees, AreTheSameBytesOnAnyNumberOfThreads) {
  std::vector<Box> boxes;
  for (int i = 0; i < 60'000; ++i) {
    Box box;
    box.grow(Vec3(std::fmod(i * 0.618, 2.0) - 1, std::fmod(i * 0.414, 2.0) - 1, 0.0));
    boxes.push_back(box);
  }
  BoxSource source = source_of(boxes);
  source.alone_from = 59'000;
  TilePool one(1), seven(7);
  const WideBvh a = build_bvh(source, 8, one), b = build_bvh(source, 8, seven);
  EXPECT_EQ(a.order, b.order);
  EXPECT_TRUE(is_same(a.nodes, b.nodes));
  EXPECT_TRUE(is_same(a.leaves, b.leaves));
}

TEST(Trees, HoldTheTrianglesOfASceneInTheSameBytesOnAnyNumberOfThreads) {
  Scene scene;
  scene.materials.resize(1);
  for (int i = 0; i < 8; ++i) {
    Object& object = scene.objects.emplace_back();
    object.shape =
        ChessPieceShape{.piece = i % 2 ? Piece::rook : Piece::knight, .position = Vec3(i, 0, 0), .detail = 1};
  }
  Object& ball = scene.objects.emplace_back();
  ball.shape = SphereShape{Vec3(3, 1, 2), 1.0};
  TilePool one(1), seven(7);
  const auto a = compile_scene(scene, one), b = compile_scene(scene, seven);
  EXPECT_GT(a->plan.triangles_instanced, 5000);
  EXPECT_TRUE(is_same(a->tree.nodes, b->tree.nodes));
  EXPECT_TRUE(is_same(a->tree.blocks, b->tree.blocks));
}

}  // namespace
}  // namespace tilelight
