// SPDX-License-Identifier: Apache-2.0
// Hostile and oversized documents: one clean error, and no memory taken for what exceeds a limit.
#include <gtest/gtest.h>

#include <chrono>

#include "renderer/base/hash.h"
#include "scene_support.h"

namespace tilelight {
namespace {

using test::error_of;
using test::full_document;
using test::scene_of;

constexpr auto kSphere = R"({"type": "sphere"})";

std::string repeated(std::string_view text, int count) {
  std::string out;
  for (int i = 0; i < count; ++i) out += text;
  return out;
}

SceneErrors refused(std::string_view text, const Limits& limits = {}) {
  auto scene = parse_scene(text, limits);
  EXPECT_FALSE(scene);
  return scene ? SceneErrors{} : std::move(scene.error());
}

TEST(NotJson, IsToldWithLineAndColumn) {
  struct Case {
    std::string text;
    int line, column;
  };
  const Case cases[] = {{"", 1, 1},
                        {"{\n  \"a\": 1,\n}", 3, 1},
                        {"{\"objects\": [}", 1, 14},
                        {"{} {}", 1, 4},
                        {"{\"a\": NaN}", 1, 7},
                        {"{\"a\": 01}", 1, 8},
                        {"// comment\n{}", 1, 1},
                        {"{\"a\": \"\xFF\"}", 1, 8},
                        {"{\"a\": \"\xC0\xAF\"}", 1, 8},
                        {"{\"\xED\xA0\x80\": 1}", 1, 4},
                        {std::string("{\"a\": \0}", 8), 1, 7},
                        {"{\"a\": \"\\ud800\"}", 1, 14}};
  for (const Case& c : cases) {
    const SceneErrors errors = refused(c.text);
    ASSERT_EQ(errors.errors.size(), 1u) << c.text;
    EXPECT_EQ(errors.kind, SceneErrors::Kind::not_json) << c.text;
    EXPECT_EQ(errors.errors[0].code, "not_json");
    EXPECT_EQ(errors.errors[0].line, c.line) << c.text << " " << errors.errors[0].detail;
    EXPECT_NEAR(errors.errors[0].column, c.column, 1) << c.text << " " << errors.errors[0].detail;
    EXPECT_FALSE(errors.errors[0].detail.empty());
    for (const char byte : errors.errors[0].detail) EXPECT_GE(byte, 0) << "the message must be UTF-8 itself";
  }
}

TEST(Limits, StopDeepNestingWithOneError) {
  for (const char* open : {"[", "{\"a\":", "[{\"a\":"}) {
    const std::string document = "{\"objects\": " + repeated(open, 100'000);
    const SceneErrors errors = refused(document);
    ASSERT_EQ(errors.errors.size(), 1u);
    EXPECT_EQ(errors.kind, SceneErrors::Kind::too_large);
    EXPECT_EQ(errors.errors[0].code, "limit");
    EXPECT_NE(errors.errors[0].detail.find("json_depth"), std::string::npos);
    EXPECT_EQ(errors.errors[0].pointer.rfind("/objects/", 0), 0u);
  }
  EXPECT_TRUE(parse_scene("{\"extras\": " + repeated("[", 63) + repeated("]", 63) + ", \"objects\": [" + kSphere + "]}",
                          Limits{}));
}

TEST(Limits, StopTooManyBytesBeforeReading) {
  Limits limits;
  limits.bytes = 100;
  const SceneErrors errors = refused(std::string(101, '{'), limits);
  EXPECT_EQ(errors.kind, SceneErrors::Kind::too_large);
  EXPECT_NE(errors.errors[0].detail.find("100"), std::string::npos);
}

TEST(Limits, StopTooManyValuesWhileReading) {
  for (const char* value : {"[]", "{}", "null", "\"\"", "[1,null]"}) {
    const SceneErrors errors = refused("{\"extras\": [" + repeated(std::string(value) + ",", 1'100'000) + "0]}");
    EXPECT_EQ(errors.kind, SceneErrors::Kind::too_large) << value;
    ASSERT_EQ(errors.errors.size(), 1u);
    EXPECT_NE(errors.errors[0].detail.find("json_values"), std::string::npos);
  }
}

TEST(Limits, CountOneNumberTooManyAmongOthersWithoutThem) {
  // Numbers in a row are free, but a list that turns out to hold something else is not.
  Limits limits;
  limits.json_values = 1000;
  EXPECT_TRUE(parse_scene("{\"extras\": [" + repeated("1,", 5000) + "1], \"objects\": [" + kSphere + "]}", limits));
  EXPECT_EQ(refused("{\"extras\": [" + repeated("1,", 5000) + "null], \"objects\": [" + kSphere + "]}", limits).kind,
            SceneErrors::Kind::too_large);
}

TEST(Limits, HoldObjectsLightsAndMaterials) {
  Limits limits;
  limits.objects = limits.lights = limits.materials = 2;
  const std::string light = R"({"type": "point", "position": [0,0,0]})";
  EXPECT_EQ(error_of(scene_of(repeated(std::string(kSphere) + ",", 2) + kSphere), "limit", limits).pointer, "/objects");
  EXPECT_EQ(
      error_of(scene_of(kSphere, "\"lights\": [" + repeated(light + ",", 2) + light + "],"), "limit", limits).pointer,
      "/lights");
  EXPECT_EQ(error_of(scene_of(kSphere, R"("materials": {"a": {}, "b": {}, "c": {}},)"), "limit", limits).pointer,
            "/materials");
  EXPECT_EQ(error_of(scene_of(R"({"type": "sphere", "material": {}})", R"("materials": {"a": {}, "b": {}},)"), "limit",
                     limits)
                .pointer,
            "/objects/0/material");
}

TEST(Limits, HoldTrianglesBeforeAndAfterInstancing) {
  Limits limits;
  limits.mesh_triangles = 3;
  limits.instanced_triangles = 5;
  const std::string two = R"({"positions": [0,0,0,1,0,0,0,1,0], "indices": [0,1,2,0,1,2]})";
  const std::string one = R"({"positions": [0,0,0,1,0,0,0,1,0], "indices": [0,1,2]})";
  const std::string use = R"({"type": "mesh", "mesh": "a"})";
  const std::string fits = "\"meshes\": {\"a\": " + two + ", \"b\": " + one + "},";
  EXPECT_TRUE(parse_scene(scene_of(use + "," + use, fits), limits));
  EXPECT_EQ(error_of(scene_of(use + "," + use + "," + use, fits), "limit", limits).pointer, "/objects/2");
  EXPECT_EQ(error_of(scene_of(use, "\"meshes\": {\"a\": " + two + ", \"b\": " + two + "},"), "limit", limits).pointer,
            "/meshes/b");
  limits.instanced_triangles = 400'000;
  EXPECT_TRUE(parse_scene(scene_of(R"({"type": "chess_position", "detail": 16})"), limits));
  EXPECT_EQ(error_of(scene_of(R"({"type": "chess_position", "detail": 512})"), "limit", limits).pointer, "/objects/0");
  EXPECT_EQ(error_of(scene_of(R"({"type": "chess_piece", "piece": "queen", "detail": 512})"), "limit", limits).pointer,
            "/objects/0");
}

TEST(Limits, MayBeSmallerThanTheDefaults) {
  Limits limits;
  limits.samples = 4;
  limits.max_depth = 2;
  limits.ray_budget = 10;
  const auto scene = parse_scene(scene_of(kSphere), limits);
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->view.render.samples, 4);
  EXPECT_EQ(scene->view.render.max_depth, 2);
  EXPECT_EQ(scene->view.render.ray_budget, 10);
}

TEST(Limits, ArePublished) {
  const std::string json = limits_json(Limits{});
  for (const char* name :
       {"bytes", "json_depth", "json_values", "objects", "lights", "materials", "mesh_triangles", "instanced_triangles",
        "pixels", "image_side", "samples", "max_depth", "ray_budget", "time_ms"}) {
    EXPECT_NE(json.find("\"" + std::string(name) + "\""), std::string::npos) << name;
  }
}

TEST(LargeMeshes, ParseInReasonableTime) {
  constexpr int kVertices = 330'000, kTriangles = 330'000;  // about two million numbers
  std::string text = R"({"objects": [{"type": "mesh", "mesh": "m"}], "meshes": {"m": {"positions": [0)";
  for (int i = 1; i < 3 * kVertices; ++i) text += "," + std::to_string(i % 1000) + "." + std::to_string(i % 7);
  text += R"(], "indices": [0)";
  for (int i = 1; i < 3 * kTriangles; ++i) text += "," + std::to_string((i * 7) % kVertices);
  text += "]}}}";
  const auto begin = std::chrono::steady_clock::now();
  const auto scene = parse_scene(text, Limits{});
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  ASSERT_TRUE(scene) << test::listed(scene.error().errors);
  EXPECT_EQ(scene->scene.meshes[0].positions.size(), static_cast<size_t>(kVertices));
  EXPECT_LT(seconds, 20.0);  // a bound against quadratic work, not a benchmark
}

TEST(MisspeltNames, AmongTenThousandLongOnesAreAnsweredInReasonableTime) {
  const std::string stem(55, 'a');
  std::string materials, objects;
  for (int i = 10'000; i < 19'999; ++i) {
    materials += (i > 10'000 ? ", \"" : "\"") + stem + "m" + std::to_string(i) + "\": {}";
    objects += (i > 10'000 ? ", " : "") + std::string(R"({"type": "sphere", "material": ")") + stem + "x" +
               std::to_string(i) + "\"}";
  }
  const auto begin = std::chrono::steady_clock::now();
  const SceneErrors errors = refused("{\"materials\": {" + materials + "}, \"objects\": [" + objects + "]}");
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  ASSERT_EQ(errors.errors.size(), 100u);
  EXPECT_EQ(errors.errors[0].hint.rfind("did you mean", 0), 0u);
  EXPECT_LT(seconds, 20.0);  // a bound against quadratic work, not a benchmark: once it was minutes
}

TEST(UnknownKeys, InLargeObjectsAreAnsweredWithTheirPlaces) {
  std::string text = "{\n\"objects\": [{\"type\": \"sphere\"}]";
  for (int i = 100'000; i < 600'000; ++i) text += ",\n\"key" + std::to_string(i) + "\": 1";
  const SceneErrors errors = refused(text + "}");
  ASSERT_EQ(errors.errors.size(), 100u);
  for (int i = 0; i < 99; ++i) {
    EXPECT_EQ(errors.errors[static_cast<size_t>(i)].pointer, "/key" + std::to_string(100'000 + i));
    EXPECT_EQ(errors.errors[static_cast<size_t>(i)].line, 3 + i);
  }
}

// Deterministic damage to a valid document: whatever comes out, nothing crashes, and every error is well formed.
TEST(DamagedDocuments, NeverCrashTheParser) {
  const std::string original(full_document());
  constexpr std::string_view kBytes = "{}[]\",:0123456789.eE+-\\untrfalse \n\xC3\xA9\xFF";
  int accepted = 0;
  for (uint64_t round = 0; round < 6000; ++round) {
    std::string text = original;
    uint64_t random = mix64(round);
    const int edits = 1 + static_cast<int>(round % 4);
    for (int i = 0; i < edits; ++i) {
      random = mix64(random);
      const size_t at = random % text.size(), length = 1 + (random >> 40) % 12;
      switch (random >> 32 & 3) {
        case 0:
          text[at] = kBytes[(random >> 50) % kBytes.size()];
          break;
        case 1:
          text.erase(at, length);
          break;
        case 2:
          text.insert(at, 1, kBytes[(random >> 50) % kBytes.size()]);
          break;
        default:
          text.insert(at, original.substr(mix64(random) % original.size(), length));
          break;
      }
    }
    const auto scene = parse_scene(text, Limits{});
    if (scene) {
      ++accepted;
      continue;
    }
    ASSERT_FALSE(scene.error().errors.empty()) << text;
    for (const SceneError& error : scene.error().errors) {
      ASSERT_FALSE(error.code.empty() || error.detail.empty()) << text;
      ASSERT_GT(error.line, 0) << text << "\n" << test::listed(scene.error().errors);
    }
  }
  EXPECT_GT(accepted, 0);
}

}  // namespace
}  // namespace tilelight
