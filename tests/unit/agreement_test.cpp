// SPDX-License-Identifier: Apache-2.0
// The kernels against the reference renderer on random scenes, by counts of pixels.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "renderer/measure/judge.h"
#include "renderer/scene/parse.h"
#include "tests/unit/agreement_scenes.h"

namespace tilelight {
namespace {

constexpr int kScenes = 200;
constexpr int kSizePx = 48;

TEST(Agreement, OfKernelsAndReferenceHoldsOnRandomScenes) {
  TilePool pool;
  ImageDifference total;
  for (uint64_t seed = 0; seed < kScenes; ++seed) {
    const agreement::RandomScene random = agreement::make_random_scene(seed, kSizePx);
    const ImageDifference d = judge_view(random.scene, random.view, pool).difference;
    // One scene may have a silhouette where rounding shows; ten pixels are something else.
    EXPECT_LE(d.id_mismatches, 3) << "scene " << seed;
    EXPECT_LE(d.q8_differing, 10) << "scene " << seed;
    total.pixels += d.pixels;
    total.id_mismatches += d.id_mismatches;
    total.q8_differing += d.q8_differing;
  }
  EXPECT_EQ(total.pixels, int64_t{kScenes} * kSizePx * kSizePx);
  EXPECT_LE(total.id_mismatch_rate(), kMaxIdMismatchRate) << total.id_mismatches << " pixels";
  EXPECT_LE(total.q8_rate(), kMaxQ8Rate) << total.q8_differing << " pixels";
}

// Scenes whose surfaces coincide, or whose eye is inside of things, in both orders of the objects: what random scenes
// do not come upon.
TEST(Agreement, HoldsWhereSurfacesAndMediaMeetInOnePlace) {
  const std::string glass = R"("material": "glass")",
                    floor = R"({"type": "box", "min": [-3, -1, -3], "max": [3, 0, 3]})";
  const std::string block = R"({"type": "box", "min": [-1, 0, -1], "max": [1, 1, 1], )" + glass + "}";
  const std::string ball = R"({"type": "sphere", "center": [0, 1, 3], "radius": 2.5, )" + glass + "}";
  const std::string bubble = R"({"type": "sphere", "center": [0, 1, 3], "radius": 1, "material": "air"})";
  const std::string pool_floor = R"({"type": "plane"})";
  const std::string twin = R"({"type": "box", "min": [-1, 0, -1], "max": [1, 1, 1]})";
  TilePool pool;
  const std::string water = R"({"type": "box", "min": [-3, -1, -3], "max": [3, 0, 3], "material": "water"})";
  const std::string film = R"({"type": "plane", "material": "glass"})";
  const std::string flush = R"({"type": "box", "min": [-2, -0.5, -2], "max": [2, 0, 2], "material": "glass"})";
  for (const auto& [below, above] : {std::pair(floor, block),
                                     {pool_floor, block},
                                     {ball, bubble},
                                     {twin, block},
                                     {water, block},
                                     {film, block},
                                     {film, floor},
                                     {film, water},
                                     {water, flush},
                                     {block, block}}) {
    for (const bool reversed : {false, true}) {
      const std::string json = R"({"image": {"width": 64, "height": 48}, "camera": {"position": [0.3, 1.2, 3.1]},
        "materials": {"glass": {"diffuse": 0.05, "reflection": 0.1, "transmission": [0.9, 0.6, 0.6]},
                      "air": {"diffuse": 0, "transmission": 1, "ior": 1},
                      "water": {"diffuse": 0, "transmission": [0.6, 0.9, 0.9], "ior": 1.33}},
        "lights": [{"type": "point", "position": [2, 4, 1], "intensity": 5}],
        "objects": [)" + (reversed ? above + ", " + below : below + ", " + above) +
                               ", {\"type\": \"sphere\", \"center\": [-1.5, 0.5, -2]}]}";
      const auto parsed = parse_scene(json, Limits{});
      ASSERT_TRUE(parsed) << parsed.error().errors[0].detail << json;
      for (const int depth : {8, 0}) {
        View view = parsed->view;
        view.render.max_depth = depth;
        const ImageDifference d = judge_view(parsed->scene, view, pool).difference;
        EXPECT_EQ(d.id_mismatches, 0) << json << depth;
        EXPECT_LE(d.q8_differing, 1) << json << depth;
      }
    }
  }
}

// A shuffled world of blocks on a grid, so that most share faces with others, as boxes, cubes of triangles and turned
// ones, of glass, water, films and wood.
class TouchingWorld {
 public:
  explicit TouchingWorld(uint64_t seed) : random_(seed) {
    objects_.push_back(R"({"type": "plane", "material": "wood"})");
    for (int x = -1; x <= 1; ++x)
      for (int z = -1; z <= 1; ++z)
        for (int level = 0; level < 2; ++level)
          if (random_() % 3) objects_.push_back(block(x, level, z));
    objects_.push_back(R"({"type": "sphere", "center": [0.5, 2.4, 0.5], "radius": 0.4, "material": "glass"})");
    objects_.push_back(R"({"type": "box", "min": [-1, 1, -1], "max": [2, 1, 2], "material": "film"})");
  }
  std::string json() const {
    std::string list;
    for (const std::string& object : objects_) list += (list.empty() ? "" : ", ") + object;
    return R"({"image": {"width": 40, "height": 30}, "camera": {"position": [3.1, 3.3, 4.7], "target": [0.5, 0.8, 0.5]},
      "render": {"max_depth": 7, "samples": 1},
      "materials": {"wood": {"diffuse": {"checker": {"size": 0.5}}},
        "glass": {"diffuse": 0.02, "reflection": 0.1, "transmission": [0.9, 0.8, 0.7], "specular": 0.4},
        "flint": {"diffuse": 0, "reflection": 1, "transmission": 1, "fresnel": true, "ior": 1.7},
        "water": {"diffuse": 0.01, "transmission": [0.7, 0.9, 0.9], "ior": 1.33, "priority": -1},
        "film": {"diffuse": 0.1, "transmission": [0.9, 0.6, 0.6], "reflection": 0.1}},
      "lights": [{"type": "point", "position": [4, 6, 3], "intensity": 9}],
      "meshes": {"cube": {"positions": [0,0,0, 1,0,0, 0,1,0, 1,1,0, 0,0,1, 1,0,1, 0,1,1, 1,1,1], "indices": [
        0,4,6, 0,6,2, 1,3,7, 1,7,5, 0,1,5, 0,5,4, 2,6,7, 2,7,3, 0,2,3, 0,3,1, 4,5,7, 4,7,6]}},
      "objects": [)" +
           list + "]}";
  }
  void shuffle() { std::shuffle(objects_.begin(), objects_.end(), random_); }

 private:
  std::string block(int x, int y, int z) {
    const char* const materials[] = {"glass", "flint", "water", "glass", "wood"};
    const std::string material = std::string(R"(, "material": ")") + materials[random_() % 5] + "\"}";
    const auto place = [](int a, int b, int c) {
      return "[" + std::to_string(a) + ", " + std::to_string(b) + ", " + std::to_string(c) + "]";
    };
    switch (random_() % 3) {
      case 0:
        return R"({"type": "box", "min": )" + place(x, y, z) + R"(, "max": )" + place(x + 1, y + 1, z + 1) + material;
      case 1:
        return R"({"type": "mesh", "mesh": "cube", "translate": )" + place(x, y, z) + material;
      default:
        return R"({"type": "mesh", "mesh": "cube", "scale": [-1, 1, 1], "translate": )" + place(x + 1, y, z) + material;
    }
  }

  std::mt19937_64 random_;
  std::vector<std::string> objects_;
};

TEST(Agreement, HoldsInWorldsOfTouchingMediaWhoseOrderChangesNoByte) {
  TilePool pool;
  ImageDifference total;
  for (uint64_t seed = 0; seed < 40; ++seed) {
    TouchingWorld world(seed);
    const auto first = parse_scene(world.json(), Limits{});
    ASSERT_TRUE(first) << first.error().errors[0].detail << world.json();
    const Verdict verdict = judge_view(first->scene, first->view, pool);
    total.pixels += verdict.difference.pixels;
    total.id_mismatches += verdict.difference.id_mismatches;
    total.q8_differing += verdict.difference.q8_differing;
    EXPECT_LE(verdict.difference.q8_differing, 3) << world.json();
    for (int i = 0; i < 3; ++i) {
      world.shuffle();
      const auto shuffled = parse_scene(world.json(), Limits{});
      ASSERT_TRUE(shuffled);
      EXPECT_EQ(judge_view(shuffled->scene, shuffled->view, pool).fast.rgb, verdict.fast.rgb) << world.json();
    }
  }
  EXPECT_LE(total.id_mismatch_rate(), kMaxIdMismatchRate) << total.id_mismatches << " pixels";
  EXPECT_LE(total.q8_rate(), kMaxQ8Rate) << total.q8_differing << " pixels";
}

// Meshes whose facets lie on each other, whose shells overlap or are wound against each other, and which lie far away.
TEST(Agreement, HoldsForGlassMeshesThatTouchOrOverlapThemselves) {
  const std::string slit = R"([0,0,-1, 4,0,-1, 4,2,-1, 2,2,-1, 4.5,2,-1, 4.5,4,-1, 0,4,-1,
                               0,0,1, 4,0,1, 4,2,1, 2,2,1, 4.5,2,1, 4.5,4,1, 0,4,1], "indices": [
    0,1,7, 1,8,7, 1,2,8, 2,9,8, 2,3,9, 3,10,9, 3,4,10, 4,11,10, 4,5,11, 5,12,11, 5,6,12, 6,13,12, 6,0,13, 0,7,13,
    3,1,0, 3,2,1, 6,3,0, 6,4,3, 6,5,4, 7,8,10, 8,9,10, 7,10,13, 10,11,13, 11,12,13])";
  const auto cubes = [](const char* second, const char* indices) {
    return std::string("[0,0,0, 1,0,0, 0,1,0, 1,1,0, 0,0,1, 1,0,1, 0,1,1, 1,1,1, ") + second + R"(], "indices": [
      0,4,6, 0,6,2, 1,3,7, 1,7,5, 0,1,5, 0,5,4, 2,6,7, 2,7,3, 0,2,3, 0,3,1, 4,5,7, 4,7,6, )" +
           indices + "]";
  };
  const char* right =
      "8,12,14, 8,14,10, 9,11,15, 9,15,13, 8,9,13, 8,13,12, 10,14,15, 10,15,11, 8,10,11, 8,11,9, 12,13,15, 12,15,14";
  const char* wrong =
      "14,12,8, 10,14,8, 15,11,9, 13,15,9, 13,9,8, 12,13,8, 15,14,10, 11,15,10, 11,10,8, 9,11,8, 15,13,12, 14,15,12";
  const char* above = "0,1,0, 1,1,0, 0,2,0, 1,2,0, 0,1,1, 1,1,1, 0,2,1, 1,2,1";
  const char* aside = "0.5,0,0, 1.5,0,0, 0.5,1,0, 1.5,1,0, 0.5,0,1, 1.5,0,1, 0.5,1,1, 1.5,1,1";
  const std::string outside = R"("position": [7, 5, 8], "target": [1.5, 1.5, 0], "fov_y_deg": 40)";
  const std::string inside = R"("position": [0.7, 0.5, 0.5], "target": [1.7, 0.8, 0.6], "fov_y_deg": 100)";
  TilePool pool;
  for (const auto& [mesh, eye] : {std::pair(slit, outside),
                                  {slit, inside},
                                  {cubes(above, right), outside},
                                  {cubes(above, wrong), outside},
                                  {cubes(above, wrong), inside},
                                  {cubes(aside, right), outside},
                                  {cubes(aside, right), inside}}) {
    const std::string json = R"({"image": {"width": 64, "height": 48}, "camera": {)" + eye + R"(},
      "materials": {"glass": {"diffuse": 0.03, "reflection": 0.1, "transmission": [0.9, 0.8, 0.7]},
                    "floor": {"diffuse": {"checker": {"size": 0.5}}}},
      "lights": [{"type": "point", "position": [4, 6, 3], "intensity": 9}], "meshes": {"m": {"positions": )" +
                             mesh + R"(}},
      "objects": [{"type": "plane", "point": [0, -0.5, 0], "material": "floor"},
                  {"type": "mesh", "mesh": "m", "material": "glass"}]})";
    const auto parsed = parse_scene(json, Limits{});
    ASSERT_TRUE(parsed) << parsed.error().errors[0].detail << json;
    for (const int depth : {8, 0}) {
      View view = parsed->view;
      view.render.max_depth = depth;
      const ImageDifference d = judge_view(parsed->scene, view, pool).difference;
      EXPECT_EQ(d.id_mismatches, 0) << json << depth;
      EXPECT_LE(d.q8_differing, 2) << json << depth;
    }
  }
}

// Each ray of an orthographic view starts in the media of its own place on the image plane.
TEST(Agreement, HoldsWhereTheImagePlaneCutsMedia) {
  const std::string common = R"({"image": {"width": 64, "height": 64}, "render": {"max_depth": 5},
    "materials": {"glass": {"diffuse": 0.05, "transmission": [0.9, 0.6, 0.6]},
                  "water": {"diffuse": 0, "transmission": 0.9, "ior": 1.33, "priority": -1}},
    "objects": [{"type": "sphere", "center": [-1, 0.5, 0.5], "material": "glass"},
                {"type": "box", "min": [-2, -1, -2], "max": [0.5, 0.4, 2], "material": "water"},
                {"type": "chess_piece", "piece": "pawn", "position": [1, -0.5, 0], "detail": 16, "material": "glass"},
                {"type": "sphere", "center": [0, 0, -4], "radius": 1.5, "material": "glass"},
                {"type": "plane", "point": [0, -2, 0], "material": {"diffuse": {"checker": {}}}}],
    "camera": {"type": "orthographic", "height": 4, )";
  TilePool pool;
  for (const char* place : {R"("position": [0, 0, 0.1], "target": [0, -0.3, -4])", R"("position": [-1, 0.5, 0.5])",
                            R"("position": [3, 1, 0.2], "target": [0, 0, 0])"}) {
    const auto parsed = parse_scene(common + place + "}}", Limits{});
    ASSERT_TRUE(parsed) << parsed.error().errors[0].detail;
    const ImageDifference d = judge_view(parsed->scene, parsed->view, pool).difference;
    EXPECT_EQ(d.id_mismatches, 0) << place;
    EXPECT_LE(d.q8_differing, 2) << place;
  }
}

TEST(Agreement, HoldsForDirectionsWhoseSquaresAreTooSmallForADouble) {
  const auto parsed =
      parse_scene(R"({"image": {"width": 48, "height": 32}, "ambient": 0, "background": {"top": 0, "bottom": 0},
    "lights": [{"type": "directional", "direction": [-1e-320, -2e-320, -1e-320]}],
    "objects": [{"type": "sphere"}, {"type": "plane", "point": [0, -1, 0], "normal": [0, 1e-200, 1e-201]}]})",
                  Limits{});
  ASSERT_TRUE(parsed) << parsed.error().errors[0].detail;
  TilePool pool(2);
  const Verdict verdict = judge_view(parsed->scene, parsed->view, pool);
  EXPECT_EQ(verdict.difference.id_mismatches, 0);
  EXPECT_EQ(verdict.difference.q8_differing, 0);
  EXPECT_EQ(verdict.fast_nonfinite, 0);
  const auto lit = std::count_if(verdict.fast.rgb.begin(), verdict.fast.rgb.end(), [](uint8_t v) { return v > 100; });
  EXPECT_GT(lit, 1000) << "the light lights";
}

}  // namespace
}  // namespace tilelight
