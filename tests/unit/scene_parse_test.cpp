// SPDX-License-Identifier: Apache-2.0
// What documents mean: defaults, names, materials, transforms, stop rules.
#include <gtest/gtest.h>

#include <cmath>

#include "scene_support.h"

namespace tilelight {
namespace {

using test::full_document;
using test::parsed;
using test::scene_of;

constexpr std::string_view kSphere = R"({"type": "sphere"})";

const Color& plain(const Paint& paint) { return std::get<Color>(paint); }
void expect_near(const Vec3& a, const Vec3& b, double tolerance = 1e-12) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}
Vec3 moved(const Object& object, const Vec3& p) { return transform_point(object.world_from_shape, p - object.pivot); }

TEST(ParseScene, ReadsADocumentWithEverythingInIt) {
  const ParsedScene p = parsed(full_document());
  ASSERT_EQ(p.scene.objects.size(), 8u);
  ASSERT_EQ(p.scene.lights.size(), 2u);
  ASSERT_EQ(p.scene.meshes.size(), 2u);
  EXPECT_TRUE(p.warnings.empty());
  EXPECT_EQ(p.scene.lights[0].name, "lamp");
  EXPECT_EQ(p.scene.lights[0].position, Vec3(5, 8, 4));
  EXPECT_FALSE(p.scene.lights[1].shadow);
  EXPECT_EQ(p.scene.attenuation.k, 6.0);
  EXPECT_EQ(p.scene.objects[2].name, "ball");
  EXPECT_EQ(p.scene.materials[p.scene.objects[2].material].name, "glass");
  EXPECT_TRUE(p.scene.materials[p.scene.objects[2].material].fresnel);
  EXPECT_EQ(p.scene.materials[p.scene.objects[7].material].name, "green");
  EXPECT_EQ(p.scene.meshes[0].indices.size(), 12u);
  EXPECT_EQ(p.scene.meshes[1].normals.size(), 3u);
  EXPECT_EQ(p.view.camera->position, Vec3(4, 5, 9));
  EXPECT_EQ(p.view.render.passes, (std::vector<double>{1, 1, 2}));
}

TEST(ParseScene, NeedsNothingButOneObject) {
  const ParsedScene p = parsed(scene_of(kSphere));
  ASSERT_EQ(p.scene.objects.size(), 1u);
  const auto& sphere = std::get<SphereShape>(p.scene.objects[0].shape);
  EXPECT_EQ(sphere.center, Vec3(0.0));
  EXPECT_EQ(sphere.radius, 1.0);
  EXPECT_EQ(p.scene.objects[0].world_from_shape, Mat4(1.0));
  EXPECT_FALSE(p.view.camera);
  EXPECT_EQ(p.view.image.width, 1280);
  EXPECT_EQ(p.view.image.height, 720);
  EXPECT_EQ(p.view.render.max_depth, 8);
  EXPECT_EQ(p.view.render.weight_cutoff, 0.002);
  EXPECT_EQ(p.view.render.samples, 16);
  EXPECT_TRUE(p.view.render.samples_implied);
  EXPECT_EQ(p.scene.ambient, Color(0.12));
  EXPECT_EQ(p.scene.attenuation.mode, AttenuationMode::linear);
  EXPECT_EQ(p.scene.attenuation.k, 1.0);
  EXPECT_EQ(p.scene.background.top, Color(0.35, 0.5, 0.8));
  ASSERT_EQ(p.scene.lights.size(), 2u);
  EXPECT_EQ(p.scene.lights[0].direction, Vec3(-1, -2, -1.5));
  EXPECT_EQ(p.scene.lights[0].intensity, 0.7);
  EXPECT_TRUE(p.scene.lights[0].shadow);
  EXPECT_EQ(p.scene.lights[1].direction, Vec3(1, -1, -0.5));
  EXPECT_EQ(p.scene.lights[1].intensity, 0.25);
  EXPECT_FALSE(p.scene.lights[1].shadow);
}

TEST(ParseScene, TakesAnEmptyListOfLightsAsNone) {
  EXPECT_TRUE(parsed(scene_of(kSphere, R"("lights": [],)")).scene.lights.empty());
}

TEST(Materials, TakeAmbientFromDiffuseItsCheckerToo) {
  const ParsedScene p = parsed(scene_of(
      R"({"type": "sphere", "material": {"diffuse": {"checker": {"a": 1, "b": [0.1, 0.2, 0.3], "size": 0.25}}}},
         {"type": "sphere", "material": {"diffuse": 0.3}},
         {"type": "sphere", "material": {"diffuse": 0.3, "ambient": 0.1}}, {"type": "sphere"})"));
  const auto material = [&](size_t i) -> const Material& { return p.scene.materials[p.scene.objects[i].material]; };
  const auto& ambient = std::get<Checker>(material(0).ambient);
  EXPECT_EQ(ambient.a, Color(1.0));
  EXPECT_EQ(ambient.b, Color(0.1, 0.2, 0.3));
  EXPECT_EQ(ambient.size, 0.25);
  EXPECT_EQ(plain(material(1).ambient), Color(0.3));
  EXPECT_EQ(plain(material(2).ambient), Color(0.1));
  EXPECT_EQ(p.scene.objects[3].material, 0u);
  EXPECT_EQ(plain(material(3).diffuse), Color(0.8));
  EXPECT_EQ(material(3).ior, 1.5);
}

TEST(Materials, LineariseHexadecimalColoursAsSrgb) {
  const ParsedScene p = parsed(scene_of(R"({"type": "sphere", "material": {"diffuse": "#00ff80"}})"));
  const Color diffuse = plain(p.scene.materials[p.scene.objects[0].material].diffuse);
  EXPECT_EQ(diffuse.r, 0.0);
  EXPECT_EQ(diffuse.g, 1.0);
  EXPECT_NEAR(diffuse.b, 0.2158605, 1e-7);  // sRGB 128, IEC 61966-2-1
}

TEST(Materials, GiveAChessSetItsOwnUnlessOverridden) {
  const ParsedScene p = parsed(scene_of(
      R"({"type": "chess_position", "materials": {"dark": "red", "frame": {"diffuse": 0.5}}},
         {"type": "chess_piece", "piece": "rook", "color": "black"}, {"type": "chess_piece", "piece": "king"},
         {"type": "chess_piece", "piece": "king", "material": "red", "color": "black"})",
      R"("materials": {"red": {"diffuse": [1, 0, 0]}},)"));
  const auto& set = std::get<ChessPositionShape>(p.scene.objects[0].shape);
  const auto name_of = [&](MaterialId id) { return p.scene.materials[id].name; };
  EXPECT_EQ(name_of(set.materials[static_cast<size_t>(ChessRole::white)]), "chess white");
  EXPECT_EQ(name_of(set.materials[static_cast<size_t>(ChessRole::dark)]), "red");
  EXPECT_EQ(plain(p.scene.materials[set.materials[static_cast<size_t>(ChessRole::frame)]].diffuse), Color(0.5));
  EXPECT_TRUE(set.squares[0][4].has_value());  // without a FEN the men stand as a game begins
  EXPECT_EQ(name_of(p.scene.objects[1].material), "chess black");
  EXPECT_EQ(name_of(p.scene.objects[2].material), "chess white");
  EXPECT_EQ(name_of(p.scene.objects[3].material), "red");
  EXPECT_EQ(std::get<ChessPieceShape>(p.scene.objects[3].shape).side, Side::black);
}

// A quarter turn about +y takes +x to -z (right-handed). Applied about each shape's pivot, after the scale.
TEST(Transforms, ActAboutThePivotOfEveryShape) {
  const std::string turn =
      R"("scale": [2, 1, 1], "rotate_deg": {"axis": [0, 3, 0], "angle": 90}, "translate": [0, 5, 0])";
  const ParsedScene p = parsed(
      scene_of(R"({"type": "sphere", "center": [1, 2, 3], )" + turn + R"(}, {"type": "cube", "center": [1, 2, 3], )" +
               turn + R"(}, {"type": "box", "min": [0, 0, 0], "max": [2, 4, 6], )" + turn +
               R"(}, {"type": "plane", "point": [1, 2, 3], )" + turn +
               R"(}, {"type": "chess_piece", "piece": "pawn", "position": [1, 2, 3], )" + turn + "}"));
  for (const Object& object : p.scene.objects) {
    expect_near(moved(object, {1, 2, 3}), {1, 7, 3});
    expect_near(moved(object, {2, 2, 3}), {1, 7, 1});  // +x from the pivot, stretched by 2, turned to -z
  }
}

TEST(Transforms, AboutAPointFarAwayRoundNothingNearIt) {
  const ParsedScene p = parsed(scene_of(R"({"type": "cube", "center": [1e15, -3e14, 7], "size": 2, "scale": 1e15})"));
  EXPECT_EQ(moved(p.scene.objects[0], {1e15, -3e14, 7}), Vec3(1e15, -3e14, 7));
}

TEST(Transforms, OfMeshesActAboutTheirOrigin) {
  const ParsedScene p = parsed(scene_of(R"({"type": "mesh", "mesh": "m", "scale": 3, "translate": [1, 0, 0]})",
                                        R"("meshes": {"m": {"positions": [0,0,0,1,0,0,0,1,0], "indices": [0,1,2]}},)"));
  expect_near(moved(p.scene.objects[0], {1, 1, 1}), {4, 3, 3});
}

TEST(Transforms, AgreeBetweenQuaternionAxisAndMatrix) {
  const double c = std::cos(0.35), s = std::sin(0.35), n = std::sqrt(14.0);
  char quaternion[200];
  snprintf(quaternion, sizeof quaternion, R"({"type": "sphere", "rotate_quat": [%.17g, %.17g, %.17g, %.17g]})",
           2 * s / n, 4 * s / n, 6 * s / n, 2 * c);
  const std::string axis = R"({"type": "sphere", "rotate_deg": {"axis": [10, 20, 30], "angle": 40.107045659157625}})";
  const ParsedScene p = parsed(scene_of(std::string(quaternion) + ", " + axis));
  for (const Vec3 v : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0.3, -2, 1)}) {
    expect_near(moved(p.scene.objects[0], v), moved(p.scene.objects[1], v));
  }
}

TEST(Transforms, AreExactAtQuarterTurnsAndPlainTranslations) {
  const ParsedScene p = parsed(scene_of(
      R"({"type": "cube", "rotate_deg": {"axis": [0, 0, 1], "angle": -450}},
         {"type": "sphere", "center": [1e7, 0.1, 0.3], "translate": [0.1, 0.2, 0.3]})"));
  EXPECT_EQ(moved(p.scene.objects[0], {1, 0, 0}), Vec3(0, -1, 0));
  EXPECT_EQ(Vec3(p.scene.objects[1].world_from_shape[3]), Vec3(0.1, 0.2, 0.3));
}

TEST(Transforms, MatrixIsColumnMajorAboutTheWorldsOrigin) {
  const ParsedScene p =
      parsed(scene_of(R"({"type": "sphere", "center": [1, 0, 0], "matrix": [0,1,0,0, -1,0,0,0, 0,0,1,0, 7,8,9,1]})"));
  expect_near(moved(p.scene.objects[0], {1, 0, 0}), {7, 9, 9});
}

TEST(Transforms, MayStretchAndShrinkFarWithoutBeingTakenForSingular) {
  parsed(scene_of(R"({"type": "sphere", "scale": [1, 1, 1e15]}, {"type": "sphere", "scale": [1e-30, 1e-30, 1e-30]},
                     {"type": "sphere", "scale": [1, -1, 1], "rotate_deg": {"axis": [1, 2, 3], "angle": 37}},
                     {"type": "sphere", "matrix": [1e15,1,0,0, -2e15,1,0,0, 0,0,1e-15,0, 0,0,0,1]})"));
}

TEST(Shapes, CubeIsABoxAndABoxMayBeFlat) {
  const ParsedScene p = parsed(scene_of(
      R"({"type": "cube", "center": [3, 0.5, 0], "size": 2}, {"type": "box", "min": [0, 1, 0], "max": [1, 1, 1]})"));
  EXPECT_EQ(std::get<BoxShape>(p.scene.objects[0].shape).min, Vec3(2, -0.5, -1));
  EXPECT_EQ(std::get<BoxShape>(p.scene.objects[0].shape).max, Vec3(4, 1.5, 1));
  EXPECT_TRUE(p.warnings.empty());
}

TEST(StopRules, FillInSamples) {
  const auto samples = [](const std::string& rules) {
    return parsed(scene_of(kSphere, R"("render": {)" + rules + "},")).view.render.samples;
  };
  EXPECT_EQ(samples(""), 16);
  EXPECT_EQ(samples(R"("samples": 7)"), 7);
  EXPECT_EQ(samples(R"("time_ms": 100)"), Limits{}.samples);
  EXPECT_EQ(samples(R"("time_ms": 100, "samples": 7)"), 7);
  EXPECT_EQ(samples(R"("passes": [1, 1, 2, 3])"), 7);
}

TEST(Numbers, MayBeHardButFinite) {
  const ParsedScene p = parsed(scene_of(R"({"type": "sphere", "center": [-0, 1e-320, -0.0], "radius": 4.9e-324})"));
  const auto& sphere = std::get<SphereShape>(p.scene.objects[0].shape);
  EXPECT_EQ(sphere.center.y, 1e-320);
  EXPECT_EQ(sphere.radius, 4.9e-324);
}

TEST(Warnings, TellOfWhatIsRepaired) {
  const ParsedScene p =
      parsed(scene_of(R"({"type": "mesh", "mesh": "m"}, {"type": "box", "min": [0, 0, 0], "max": [0, 0, 1]})",
                      R"("meshes": {"m": {"positions": [0,0,0, 1,0,0, 0,1,0, 2,0,0], "indices": [0,1,2, 0,1,3, 0,1,1],
                          "normals": [0,0,1, 0,0,0, 0,0,1, 0,0,1]}},)"));
  std::vector<std::string> found;
  for (const SceneWarning& w : p.warnings) found.push_back(w.pointer + " " + w.code);
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, (std::vector<std::string>{"/meshes/m degenerate_triangles", "/meshes/m zero_normals",
                                             "/objects/1 empty_box"}));
}

TEST(ChessScene, IsAValidScene) {
  const ParsedScene p = parsed(chess_scene_json("8/8/8/3k4/8/8/8/3K4 w - - 0 1", 24));
  EXPECT_EQ(std::get<ChessPositionShape>(p.scene.objects[0].shape).detail, 24);
  EXPECT_EQ(p.scene.lights.size(), 2u);
  EXPECT_TRUE(p.view.camera);
}

TEST(ChessScene, CarriesAnyTextAsItsFen) {
  for (const std::string_view fen : {"\"}],", "\xFF\xFE", "\n"}) {
    EXPECT_EQ(test::error_of(chess_scene_json(fen, 24), "bad_fen").pointer, "/objects/0/fen");
  }
}

}  // namespace
}  // namespace tilelight
