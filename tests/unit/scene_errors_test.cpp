// SPDX-License-Identifier: Apache-2.0
// What is refused, and how the refusal reads: pointer, code, place, what is allowed.
#include <gtest/gtest.h>

#include <algorithm>

#include "scene_support.h"

namespace tilelight {
namespace {

using test::error_of;
using test::errors_of;
using test::full_document;
using test::scene_of;

struct Bad {
  std::string name;
  std::string document;
  std::string code, pointer;
};
void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.name; }

std::string with(std::string_view members) { return scene_of(R"({"type": "sphere"})", std::string(members) + ","); }
std::string mesh(std::string_view data) {
  return scene_of(R"({"type": "mesh", "mesh": "m"})", R"("meshes": {"m": {)" + std::string(data) + "}},");
}
constexpr auto kTriangle = R"("positions": [0,0,0, 1,0,0, 0,1,0], "indices": [0,1,2])";

std::vector<Bad> bad_documents() {
  return {
      {"root_is_a_list", "[]", "wrong_type", ""},
      {"no_objects", "{}", "missing_key", ""},
      {"empty_objects", R"({"objects": []})", "wrong_length", "/objects"},
      {"objects_are_numbers", R"({"objects": [1, 2]})", "wrong_type", "/objects/1"},
      {"misspelt_key", scene_of(R"({"type": "sphere", "raduis": 2})"), "unknown_key", "/objects/0/raduis"},
      {"misspelt_type", scene_of(R"({"type": "shpere"})"), "unknown_word", "/objects/0/type"},
      {"no_type", scene_of(R"({"radius": 1})"), "missing_key", "/objects/0"},
      {"negative_radius", scene_of(R"({"type": "sphere", "radius": -1})"), "out_of_range", "/objects/0/radius"},
      {"zero_radius", scene_of(R"({"type": "sphere", "radius": 0})"), "out_of_range", "/objects/0/radius"},
      {"string_radius", scene_of(R"({"type": "sphere", "radius": "1"})"), "wrong_type", "/objects/0/radius"},
      {"nan_as_string", scene_of(R"({"type": "sphere", "center": [0, "NaN", 0]})"), "wrong_type",
       "/objects/0/center/1"},
      {"overflow", scene_of(R"({"type": "sphere", "center": [0, 1, 1e400]})"), "out_of_range", "/objects/0/center/2"},
      {"overflow_of_a_member", scene_of(R"({"type": "sphere", "radius": -1e999})"), "out_of_range",
       "/objects/0/radius"},
      {"beyond_magnitude", scene_of(R"({"type": "sphere", "radius": 1e31})"), "out_of_range", "/objects/0/radius"},
      {"two_components", scene_of(R"({"type": "sphere", "center": [0, 1]})"), "wrong_length", "/objects/0/center"},
      {"null", scene_of(R"({"type": "sphere", "center": null})"), "wrong_type", "/objects/0/center"},
      {"unknown_material", scene_of(R"({"type": "sphere", "material": "goold"})", R"("materials": {"gold": {}},)"),
       "unknown_name", "/objects/0/material"},
      {"unknown_mesh", scene_of(R"({"type": "mesh", "mesh": "m"})"), "unknown_name", "/objects/0/mesh"},
      {"no_mesh", scene_of(R"({"type": "mesh"})"), "missing_key", "/objects/0"},
      {"coefficient_over_1", scene_of(R"({"type": "sphere", "material": {"specular": [0, 2, 0]}})"), "out_of_range",
       "/objects/0/material/specular/1"},
      {"negative_coefficient", with(R"("materials": {"m": {"reflection": -0.1}})"), "out_of_range",
       "/materials/m/reflection"},
      {"bad_hex", with(R"("ambient": "#12345g")"), "wrong_type", "/ambient"},
      {"zero_ior", with(R"("materials": {"m": {"ior": 0}})"), "out_of_range", "/materials/m/ior"},
      {"negative_ior", with(R"("materials": {"m": {"ior": -1}})"), "out_of_range", "/materials/m/ior"},
      {"negative_shininess", with(R"("materials": {"m": {"shininess": -1}})"), "out_of_range",
       "/materials/m/shininess"},
      {"fractional_priority", with(R"("materials": {"m": {"priority": 0.5}})"), "out_of_range",
       "/materials/m/priority"},
      {"checker_without_size", with(R"("materials": {"m": {"diffuse": {"checker": {"size": 0}}}})"), "out_of_range",
       "/materials/m/diffuse/checker/size"},
      {"empty_pattern", with(R"("materials": {"m": {"diffuse": {}}})"), "missing_key", "/materials/m/diffuse"},
      {"escaped_pointer", with(R"("materials": {"a/b~c": {"ior": 0}})"), "out_of_range", "/materials/a~1b~0c/ior"},
      {"zero_scale", scene_of(R"({"type": "sphere", "scale": 0})"), "out_of_range", "/objects/0/scale"},
      {"flat_scale", scene_of(R"({"type": "sphere", "scale": [1, 0, 1]})"), "out_of_range", "/objects/0/scale/1"},
      {"singular", scene_of(R"({"type": "sphere", "matrix": [1,2,3,0, 4,5,6,0, 7,8,9,0, 0,0,0,1]})"), "singular",
       "/objects/0/matrix"},
      {"zero_matrix", scene_of(R"({"type": "sphere", "matrix": [0,0,0,0, 0,0,0,0, 0,0,0,0, 0,0,0,1]})"), "singular",
       "/objects/0/matrix"},
      {"row_major", scene_of(R"({"type": "sphere", "matrix": [1,0,0,5, 0,1,0,6, 0,0,1,7, 0,0,0,1]})"), "not_affine",
       "/objects/0/matrix"},
      {"matrix_and_scale",
       scene_of(R"({"type": "sphere", "scale": 2, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]})"), "exclusive_keys",
       "/objects/0/scale"},
      {"two_rotations", scene_of(R"({"type": "sphere", "rotate_quat": [0,0,0,1],
                                     "rotate_deg": {"axis": [1,0,0], "angle": 3}})"),
       "exclusive_keys", "/objects/0/rotate_quat"},
      {"zero_axis", scene_of(R"({"type": "sphere", "rotate_deg": {"axis": [0,0,0], "angle": 3}})"), "out_of_range",
       "/objects/0/rotate_deg/axis"},
      {"zero_quaternion", scene_of(R"({"type": "sphere", "rotate_quat": [0,0,0,0]})"), "out_of_range",
       "/objects/0/rotate_quat"},
      {"inverted_box", scene_of(R"({"type": "box", "min": [0,3,0], "max": [1,2,1]})"), "out_of_range",
       "/objects/0/max"},
      {"inverted_by_default", scene_of(R"({"type": "box", "min": [0,3,0]})"), "out_of_range", "/objects/0/min"},
      {"zero_normal", scene_of(R"({"type": "plane", "normal": [0,-0,0]})"), "out_of_range", "/objects/0/normal"},
      {"only_an_empty_box", scene_of(R"({"type": "box", "min": [0,0,0], "max": [0,0,1]})"), "no_visible_object",
       "/objects"},
      {"only_flat_triangles", mesh(R"("positions": [0,0,0, 1,0,0, 2,0,0], "indices": [0,1,2])"), "no_visible_object",
       "/objects"},
      {"bad_fen", scene_of(R"({"type": "chess_position", "fen": "8/8"})"), "bad_fen", "/objects/0/fen"},
      {"detail_too_small", scene_of(R"({"type": "chess_piece", "piece": "king", "detail": 7})"), "out_of_range",
       "/objects/0/detail"},
      {"detail_too_great", scene_of(R"({"type": "chess_position", "detail": 513})"), "out_of_range",
       "/objects/0/detail"},
      {"no_piece", scene_of(R"({"type": "chess_piece"})"), "missing_key", "/objects/0"},
      {"unknown_piece", scene_of(R"({"type": "chess_piece", "piece": "quen"})"), "unknown_word", "/objects/0/piece"},
      {"unknown_chess_role", scene_of(R"({"type": "chess_position", "materials": {"whit": 1}})"), "unknown_key",
       "/objects/0/materials/whit"},
      {"positions_not_by_three", mesh(R"("positions": [0,0,0,1], "indices": [0,0,0])"), "wrong_length",
       "/meshes/m/positions"},
      {"indices_not_by_three", mesh(R"("positions": [0,0,0, 1,0,0, 0,1,0], "indices": [0,1,2,0])"), "wrong_length",
       "/meshes/m/indices"},
      {"index_past_the_end", mesh(R"("positions": [0,0,0, 1,0,0, 0,1,0], "indices": [0,1,3])"), "out_of_range",
       "/meshes/m/indices/2"},
      {"negative_index", mesh(R"("positions": [0,0,0, 1,0,0, 0,1,0], "indices": [0,-1,2])"), "out_of_range",
       "/meshes/m/indices/1"},
      {"fractional_index", mesh(R"("positions": [0,0,0, 1,0,0, 0,1,0], "indices": [0.5,1,2])"), "out_of_range",
       "/meshes/m/indices/0"},
      {"huge_index", mesh(R"("positions": [0,0,0, 1,0,0, 0,1,0], "indices": [0,1,1e300])"), "out_of_range",
       "/meshes/m/indices/2"},
      {"empty_mesh", mesh(R"("positions": [], "indices": [])"), "wrong_length", "/meshes/m/indices"},
      {"normals_missing_one", mesh(std::string(kTriangle) + R"(, "normals": [0,0,1, 0,0,1])"), "wrong_length",
       "/meshes/m/normals"},
      {"crease_over_180", mesh(std::string(kTriangle) + R"(, "crease_deg": 181)"), "out_of_range",
       "/meshes/m/crease_deg"},
      {"asset", mesh(R"("asset": "sha256:00")"), "not_in_this_release", "/meshes/m/asset"},
      {"eye_is_target", with(R"("camera": {"position": [1,2,3], "target": [1,2,3]})"), "out_of_range",
       "/camera/position"},
      {"eye_is_default_target", with(R"("camera": {"position": [0,0,0]})"), "out_of_range", "/camera/position"},
      {"no_eye", with(R"("camera": {})"), "missing_key", "/camera"},
      {"zero_up", with(R"("camera": {"position": [1,2,3], "up": [0,0,0]})"), "out_of_range", "/camera/up"},
      {"fov_0", with(R"("camera": {"position": [1,2,3], "fov_y_deg": 0})"), "out_of_range", "/camera/fov_y_deg"},
      {"fov_180", with(R"("camera": {"position": [1,2,3], "fov_y_deg": 180})"), "out_of_range", "/camera/fov_y_deg"},
      {"fov_negative", with(R"("camera": {"position": [1,2,3], "fov_y_deg": -1})"), "out_of_range",
       "/camera/fov_y_deg"},
      {"fov_of_parallel_rays", with(R"("camera": {"type": "orthographic", "position": [1,2,3], "height": 2,
                                       "fov_y_deg": 40})"),
       "unknown_key", "/camera/fov_y_deg"},
      {"no_height", with(R"("camera": {"type": "orthographic", "position": [1,2,3]})"), "missing_key", "/camera"},
      {"zero_width", with(R"("image": {"width": 0})"), "out_of_range", "/image/width"},
      {"fractional_width", with(R"("image": {"width": 10.5})"), "out_of_range", "/image/width"},
      {"too_wide", with(R"("image": {"width": 65538})"), "limit", "/image/width"},
      {"too_many_pixels", with(R"("image": {"width": 5000, "height": 5000})"), "limit", "/image"},
      {"zero_samples", with(R"("render": {"samples": 0})"), "out_of_range", "/render/samples"},
      {"too_many_samples", with(R"("render": {"samples": 5000})"), "limit", "/render/samples"},
      {"zero_time", with(R"("render": {"time_ms": 0})"), "out_of_range", "/render/time_ms"},
      {"too_long", with(R"("render": {"time_ms": 1e9})"), "limit", "/render/time_ms"},
      {"no_passes", with(R"("render": {"passes": []})"), "wrong_length", "/render/passes"},
      {"zero_pass", with(R"("render": {"passes": [1, 0]})"), "out_of_range", "/render/passes/1"},
      {"too_many_in_passes", with(R"("render": {"passes": [4000, 97]})"), "limit", "/render/passes"},
      {"negative_depth", with(R"("render": {"max_depth": -1})"), "out_of_range", "/render/max_depth"},
      {"cutoff_over_1", with(R"("render": {"weight_cutoff": 1.5})"), "out_of_range", "/render/weight_cutoff"},
      {"negative_seed", with(R"("render": {"seed": -1})"), "out_of_range", "/render/seed"},
      {"raytracing", with(R"("render": {"algorithm": "raytracing"})"), "unknown_word", "/render/algorithm"},
      {"toon", with(R"("render": {"shading": "toon"})"), "unknown_word", "/render/shading"},
      {"soft_terminator", with(R"("render": {"terminator": "soft"})"), "unknown_word", "/render/terminator"},
      {"triangle", with(R"("render": {"filter": "triangle"})"), "unknown_word", "/render/filter"},
      {"chord_error", with(R"("render": {"chord_error_px": 0})"), "out_of_range", "/render/chord_error_px"},
      {"rmse", with(R"("render": {"rmse": 0})"), "out_of_range", "/render/rmse"},
      {"half_a_pass", with(R"("render": {"passes": [0.5, 1]})"), "fractional_first_pass", "/render/passes"},
      {"half_a_pass_after_a_sketch", with(R"("render": {"passes": [0.0625, 0.5]})"), "fractional_first_pass",
       "/render/passes"},
      {"no_pass", with(R"("render": {"passes": [1, 0]})"), "out_of_range", "/render/passes/1"},
      {"negative_k", with(R"("attenuation": {"k": -1})"), "out_of_range", "/attenuation/k"},
      {"light_without_place", with(R"("lights": [{"type": "point"}])"), "missing_key", "/lights/0"},
      {"light_without_way", with(R"("lights": [{"type": "directional", "direction": [0,0,0]}])"), "out_of_range",
       "/lights/0/direction"},
      {"negative_light", with(R"("lights": [{"type": "point", "position": [0,0,0], "intensity": -1}])"), "out_of_range",
       "/lights/0/intensity"},
      {"newer_version", with(R"("tilelight": 2, "unheard_of": 1)"), "newer_version", "/tilelight"},
      {"older_version", with(R"("tilelight": 0)"), "out_of_range", "/tilelight"},
      {"duplicate_key", scene_of(R"({"type": "sphere", "radius": 1, "radius": 2})"), "duplicate_key",
       "/objects/0/radius"},
      {"duplicate_escaped", R"({"objects": [{"type": "sphere"}], "\u006fbjects": []})", "duplicate_key", "/objects"},
      {"duplicate_material", with(R"("materials": {"a": {}, "b": {}, "a": {}})"), "duplicate_key", "/materials/a"},
  };
}

class BadDocuments : public testing::TestWithParam<Bad> {};
TEST_P(BadDocuments, AreRefusedAtTheirPlace) {
  const Bad& bad = GetParam();
  const auto errors = errors_of(bad.document);
  const bool found = std::any_of(errors.begin(), errors.end(), [&](const SceneError& e) {
    return e.code == bad.code && e.pointer == bad.pointer && !e.detail.empty() && e.line > 0 && e.column > 0;
  });
  EXPECT_TRUE(found) << "wanted " << bad.pointer << " " << bad.code << ", got:\n" << test::listed(errors);
}
INSTANTIATE_TEST_SUITE_P(Scene, BadDocuments, testing::ValuesIn(bad_documents()),
                         [](const auto& test) { return test.param.name; });

TEST(Errors, PointIntoTheDocument) {
  for (const Bad& bad : bad_documents()) {
    if (bad.document.find("1e400") != std::string::npos || bad.document.find("1e999") != std::string::npos) continue;
    for (const SceneError& error : errors_of(bad.document)) {
      EXPECT_TRUE(test::pointer_resolves(bad.document, error.pointer)) << bad.name << " " << error.pointer;
    }
  }
}

TEST(Errors, ComeAllAtOnceInTheOrderOfTheText) {
  const auto errors = errors_of(R"({
  "image": {"width": 0},
  "render": {"shading": "flot"},
  "lights": [{"type": "point", "position": [0, 0]}],
  "objects": [
    {"type": "sphere", "material": "gold", "raduis": 1},
    {"type": "sphere", "matrix": [1,0,0,0, 0,0,0,0, 0,0,1,0, 0,0,0,1]},
    {"type": "box", "min": [2,0,0]}
  ]
})");
  std::vector<std::string> found;
  for (const SceneError& e : errors) found.push_back(std::to_string(e.line) + " " + e.pointer + " " + e.code);
  EXPECT_EQ(found, (std::vector<std::string>{"2 /image/width out_of_range", "3 /render/shading unknown_word",
                                             "4 /lights/0/position wrong_length", "6 /objects/0/material unknown_name",
                                             "6 /objects/0/raduis unknown_key", "7 /objects/1/matrix singular",
                                             "8 /objects/2/min out_of_range"}));
}

TEST(Errors, KnowTheirLineAndColumn) {
  const std::string document =
      "{\n  \"x-ü\": \"ü\", \"ambient\": -1,\n  \"objects\": [\n    {\"type\": \"mesh\", "
      "\"mesh\": \"m\"}\n  ],\n\t\"meshes\": {\"m\": {\"positions\": [0,0,0,\n  1,0,0,\n  "
      "0,1,0], \"indices\": [0,1,\n      7], \"creese\": 1}}\n}";
  const auto place = [&](const char* code, const std::string& pointer) {
    for (const SceneError& e : errors_of(document)) {
      if (e.code == code && e.pointer == pointer) return std::pair(e.line, e.column);
    }
    return std::pair(0, 0);
  };
  EXPECT_EQ(place("out_of_range", "/ambient"), std::pair(2, 26));  // the value; ü is one character
  EXPECT_EQ(place("out_of_range", "/meshes/m/indices/2"), std::pair(9, 7));
  EXPECT_EQ(place("unknown_key", "/meshes/m/creese"), std::pair(9, 11));  // the key
}

TEST(Errors, SuggestWhatWasMeant) {
  EXPECT_EQ(error_of(scene_of(R"({"type": "sphere", "raduis": 2})"), "unknown_key").hint, "did you mean \"radius\"?");
  EXPECT_EQ(error_of(scene_of(R"({"type": "shpere"})"), "unknown_word").hint, "did you mean \"sphere\"?");
  EXPECT_EQ(error_of(scene_of(R"({"type": "sphere", "material": "goold"})", R"("materials": {"red": {}, "gold": {}},)"),
                     "unknown_name")
                .hint,
            "did you mean \"gold\"?");
  EXPECT_EQ(error_of(scene_of(R"({"type": "sphere"})", R"("camra": 1,)"), "unknown_key").hint,
            "did you mean \"camera\"?");
  const SceneError far = error_of(scene_of(R"({"type": "sphere"})", R"("banana": 1,)"), "unknown_key");
  EXPECT_EQ(far.hint.find("did you mean"), std::string::npos);
}

TEST(Errors, ListTheAllowedWords) {
  const SceneError error = error_of(with(R"("render": {"algorithm": "painter"})"), "unknown_word");
  EXPECT_EQ(error.allowed, (std::vector<std::string>{"raytrace", "zbuffer", "warnock", "roberts"}));
  EXPECT_NE(error.detail.find("painter"), std::string::npos);
}

TEST(Errors, SayNumbersAndNounsAsAReaderWould) {
  const SceneError size = error_of(with(R"("image": {"width": 100000})"), "limit");
  EXPECT_EQ(size.detail.find("found 100000;"), 0u) << size.detail;
  const SceneError huge = error_of(with(R"("image": {"width": 1e300})"), "limit");
  EXPECT_EQ(huge.detail.find("found 1e+300;"), 0u) << huge.detail;
  const SceneError key = error_of(with(R"("image": {"size": 1})"), "unknown_key");
  EXPECT_NE(key.detail.find("allowed in an image: "), std::string::npos) << key.detail;
}

TEST(Errors, OfOneListDoNotCrowdOutTheOthers) {
  std::string indices = "9";
  for (int i = 1; i < 300; ++i) indices += ",9";
  const auto errors = errors_of(scene_of(R"({"type": "mesh", "mesh": "m"}, {"type": "sphere", "radius": 0})",
                                         R"("meshes": {"m": {"positions": [0,0,0], "indices": [)" + indices + "]}},"));
  EXPECT_LT(errors.size(), 10u);
  EXPECT_EQ(errors.back().pointer, "/objects/1/radius");
}

TEST(Errors, AreListedUpToABound) {
  std::string objects = R"({"type": "sphere", "radius": 0})";
  for (int i = 0; i < 3000; ++i) objects += R"(, {"type": "sphere", "radius": 0})";
  const auto errors = errors_of(scene_of(objects));
  EXPECT_EQ(errors.size(), 100u);
  EXPECT_EQ(errors.back().code, "too_many_errors");
}

TEST(Warnings, AreListedUpToABound) {
  std::string objects = R"({"type": "sphere"})";
  for (int i = 0; i < 3000; ++i) objects += R"(, {"type": "box", "min": [0, 0, 0], "max": [0, 0, 1]})";
  const std::vector<SceneWarning> warnings = test::parsed(scene_of(objects)).warnings;
  ASSERT_EQ(warnings.size(), 100u);
  EXPECT_EQ(warnings[98].code, "empty_box");
  EXPECT_EQ(warnings[99].code, "too_many_warnings");
}

// What was refused or never looked at is not read as if it were of the right kind: three numbers beyond the end of
// none.
TEST(Errors, LeaveTheRestOfWhatTheyRefuseAlone) {
  const std::string camera = R"("camera": {"type": "pespective", "position": [1, 2, 3], "target": "x", "up": true})";
  EXPECT_EQ(errors_of(with(camera)).size(), 1u);
  std::string keys;
  for (int i = 0; i < 150; ++i) keys += "\"k" + std::to_string(i) + "\": 1, ";
  for (const char* rest :
       {R"("camera": {"position": "x", "target": "y"})",
        R"("lights": [{"type": "point", "color": [], "position": "x"}])",
        R"("materials": {"default": {"diffuse": [1], "specular": {"checker": 3}}})",
        R"("meshes": {"m": {"positions": "x", "indices": [true]}})", R"("image": [], "render": {"passes": "x"})"}) {
    EXPECT_FALSE(errors_of(with(keys + rest)).empty()) << rest;
  }
  EXPECT_FALSE(errors_of("{" + keys + R"("objects": [{"type": "sphere", "center": "x", "material": []}]})").empty());
}

TEST(Errors, ShortenLongTextOnACharactersBoundary) {
  std::string name;
  for (int i = 0; i < 1000; ++i) name += "\xE2\x99\x9E";
  const SceneError error = error_of(scene_of(R"({"type": "sphere", "material": ")" + name + "\"}"), "unknown_name");
  EXPECT_LT(error.detail.size(), 200u);
  EXPECT_TRUE(test::pointer_resolves(
      "\"" +
          [&] {
            std::string plain = error.detail;
            std::replace(plain.begin(), plain.end(), '"', ' ');
            return plain;
          }() +
          "\"",
      ""));  // still UTF-8
}

TEST(FreeKeys, AreFreeWhereverAnObjectStands) {
  const ParsedScene p = test::parsed(R"({"extras": [1, {"a": null}], "x-a": 1,
    "camera": {"position": [1,2,3], "extras": 1}, "image": {"x-b": {}}, "render": {"extras": {}},
    "background": {"x-": 0}, "attenuation": {"extras": 0}, "lights": [{"type": "point", "position": [0,0,0], "x-c": 0}],
    "materials": {"extras": 0, "x-d": 3, "m": {"diffuse": {"checker": {"x-e": 1}, "x-f": 0}, "extras": 1}},
    "meshes": {"x-g": 1},
    "objects": [{"type": "sphere", "material": "m", "rotate_deg": {"axis": [1,0,0], "angle": 1, "x-h": 0}, "x-i": 0},
                {"type": "chess_position", "materials": {"extras": 1}}]})");
  EXPECT_EQ(p.scene.objects.size(), 2u);
  EXPECT_EQ(
      error_of(scene_of(R"({"type": "sphere", "material": "x-d"})", R"("materials": {"x-d": {}},)"), "unknown_name")
          .pointer,
      "/objects/0/material");
}

}  // namespace
}  // namespace tilelight
