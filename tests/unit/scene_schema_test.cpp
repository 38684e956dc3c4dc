// SPDX-License-Identifier: Apache-2.0
// Parser and schema held together: over a document with everything in it and thousands of documents that differ from it
// in one place, whatever the schema refuses the parser refuses, and whatever the schema accepts the parser refuses only
// for reasons that no schema can express.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "scene_support.h"

namespace tilelight {
namespace {

using test::full_document;

// Errors that compare values with each other, or text with a notation.
bool is_beyond_schemas(const SceneError& error) {
  static const std::set<std::string> kCodes = {"unknown_name", "bad_fen",           "singular",
                                               "not_affine",   "no_visible_object", "fractional_first_pass"};
  if (kCodes.contains(error.code)) return true;
  if (error.code == "wrong_length") {
    const auto found = [&](std::string_view text) { return error.detail.find(text) != std::string::npos; };
    const bool too_short = found("an empty list") || found("a list of 1 number") || found("a list of 2 numbers");
    return (found("a multiple of 3") && !too_short) || error.pointer.ends_with("/normals");
  }
  if (error.code == "limit") return error.pointer == "/image" || error.pointer == "/render/passes";
  if (error.code != "out_of_range") return false;
  return error.detail.find("position equal to target") != std::string::npos ||
         error.detail.find("above max") != std::string::npos || error.detail.find("found index") != std::string::npos ||
         error.detail.find("found a transform") != std::string::npos;
}

// Meshes as lists of lists, and positions as programs write them.
constexpr std::string_view kOtherSpellings = R"({
  "meshes": {"tetra": {"positions": [[0,0,0], [1,0,0], [0,1,0], [0,0,1]], "indices": [[0,2,1], [0,1,3]]},
             "leaf": {"positions": [[0,0,0], [1,0,0], [0,1,0]], "indices": [[0,1,2]],
                      "normals": [[0,0,1], [0,0,1], [0,0,1]]}},
  "objects": [{"type": "mesh", "mesh": "tetra"}, {"type": "mesh", "mesh": "leaf"},
              {"type": "chess_position", "fen": "horde:rnbq1bnr/8/8/8/8/8/8/Q~7[Pp]\tw - -"}]})";

TEST(Schema, AcceptsWhatTheParserAccepts) {
  const test::SchemaJudge schema(scene_schema_json(Limits{}));
  for (const std::string& document : {std::string(full_document()), std::string(kOtherSpellings),
                                      chess_scene_json("8/8/8/8/8/8/8/8", 8), test::scene_of(R"({"type": "plane"})")}) {
    EXPECT_TRUE(schema.accepts(document)) << document;
    EXPECT_TRUE(parse_scene(document, Limits{}));
  }
}

TEST(Schema, AgreesWithTheParserOnEverySingleMutation) {
  const test::SchemaJudge schema(scene_schema_json(Limits{}));
  int both_accept = 0, both_refuse = 0, parser_alone = 0;
  std::vector<std::string> documents = test::single_mutations(full_document());
  for (std::string& document : test::single_mutations(kOtherSpellings)) documents.push_back(std::move(document));
  for (const std::string& document : documents) {
    const bool by_schema = schema.accepts(document);
    const auto scene = parse_scene(document, Limits{});
    if (scene) {
      ASSERT_TRUE(by_schema) << "the schema alone refuses " << document;
      ++both_accept;
    } else if (by_schema) {
      const auto& errors = scene.error().errors;
      ASSERT_TRUE(std::all_of(errors.begin(), errors.end(), is_beyond_schemas))
          << "the parser alone refuses " << document << "\n"
          << test::listed(errors);
      ++parser_alone;
    } else {
      const auto& errors = scene.error().errors;
      const auto is_expected = [](const SceneError& e) { return e.code != "bad_fen" && is_beyond_schemas(e); };
      ASSERT_FALSE(std::all_of(errors.begin(), errors.end(), is_expected))
          << "only the schema knows why to refuse " << document << "\n"
          << test::listed(errors);
      for (const SceneError& error : errors) {
        ASSERT_TRUE(test::pointer_resolves(document, error.pointer)) << document << "\n" << test::listed(errors);
        ASSERT_GT(error.line, 0);
      }
      ++both_refuse;
    }
  }
  EXPECT_GT(both_accept, 200);
  EXPECT_GT(both_refuse, 2000);
  EXPECT_GT(parser_alone, 50);
}

TEST(Schema, CarriesTheLimits) {
  Limits limits;
  limits.objects = 2;
  limits.samples = 7;
  const test::SchemaJudge schema(scene_schema_json(limits));
  EXPECT_TRUE(schema.accepts(R"({"objects": [{"type": "cube"}, {"type": "cube"}], "render": {"samples": 7}})"));
  EXPECT_FALSE(schema.accepts(R"({"objects": [{"type": "cube"}, {"type": "cube"}, {"type": "cube"}]})"));
  EXPECT_FALSE(schema.accepts(R"({"objects": [{"type": "cube"}], "render": {"samples": 8}})"));
}

TEST(Schema, StatesTheDefaultsThatHold) {
  const std::string bare = R"({
    "camera": {"position": [1,2,3]}, "image": {}, "render": {}, "background": {}, "attenuation": {},
    "lights": [{"type": "point", "position": [1,1,1]}, {"type": "directional", "direction": [0,-1,0]}],
    "materials": {"m": {"diffuse": {"checker": {}}}, "n": {}},
    "meshes": {"t": {"positions": [0,0,0,1,0,0,0,1,0], "indices": [0,1,2]}},
    "objects": [{"type": "sphere"}, {"type": "cube"}, {"type": "box"}, {"type": "plane"}, {"type": "mesh", "mesh": "t"},
                {"type": "chess_piece", "piece": "rook"}, {"type": "chess_position"}]})";
  int stated = 0;
  const std::string spelt_out = test::SchemaJudge(scene_schema_json(Limits{})).with_defaults(bare, stated);
  EXPECT_GT(stated, 50);
  const ParsedScene a = test::parsed(bare), b = test::parsed(spelt_out);
  EXPECT_EQ(a.scene, b.scene) << spelt_out;
  EXPECT_EQ(a.view, b.view) << spelt_out;
}

TEST(Schema, OffersEveryMethodAndShading) {
  const std::string schema = scene_schema_json(Limits{});
  for (const char* word : {"raytrace", "zbuffer", "warnock", "roberts", "flat", "gouraud", "phong"})
    EXPECT_NE(schema.find("\"" + std::string(word) + "\""), std::string::npos) << word;
}

TEST(Schema, NamesNothingThatThisReleaseCannotDo) {
  EXPECT_EQ(scene_schema_json(Limits{}).find("asset"), std::string::npos);
}

}  // namespace
}  // namespace tilelight
