// SPDX-License-Identifier: Apache-2.0
// scene_id and compile_key: equal for documents that mean the same, different for others.
#include <gtest/gtest.h>

#include "scene_support.h"

namespace tilelight {
namespace {

using test::full_document;
using test::parsed;
using test::scene_of;

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}
std::string id(std::string_view text) { return parsed(text).scene_id; }
std::string key(std::string_view text) { return parsed(text).compile_key; }

TEST(SceneId, IsASha256) {
  EXPECT_EQ(id(full_document()).size(), 64u);
  EXPECT_NE(id(full_document()), key(full_document()));
}

// Stored ids must stay valid. Computed apart from this code, in Python from the description of the form: the line
// "tilelight scene 1", then o 1 "objects" a 1 o 2 "radius" n 2.0 "type" s "sphere", lengths and doubles as 8 bytes.
TEST(SceneId, NeverChangesForAGivenScene) {
  EXPECT_EQ(id(R"({"objects": [{"type": "sphere", "radius": 2}]})"),
            "eae21a97023a8ab5ec709d3eaa97977fc6a251795680cf9a31160166b2060342");
}

TEST(SceneId, DoesNotDependOnSpellingOrOrder) {
  EXPECT_EQ(id(R"({"ambient":0.5,"objects":[{"type":"sphere","radius":2}]})"),
            id("{ \"objects\" : [ { \"radius\": 20e-1, \"ty\\u0070e\": \"sphere\" } ],\n\"tilelight\": 1, \"ambient\": "
               "5.0E-1 }"));
  EXPECT_EQ(id(scene_of(R"({"type": "sphere", "center": [0, -0, -0.0]})")),
            id(scene_of(R"({"type": "sphere", "center": [0, 0, 0.0]})")));
}

TEST(SceneId, LeavesOutWhatIsForPeople) {
  const std::string bare = scene_of(R"({"type": "sphere"})");
  EXPECT_EQ(id(bare), id(scene_of(R"({"type": "sphere", "name": "ball", "extras": {"a": 1}, "x-b": 2})",
                                  R"("extras": 1, "x-c": [],)")));
  // but not what is the user's name for something
  EXPECT_NE(id(scene_of(R"({"type": "sphere", "material": "name"})", R"("materials": {"name": {"diffuse": 0.1}},)")),
            id(scene_of(R"({"type": "sphere", "material": "name"})", R"("materials": {"name": {"diffuse": 0.2}},)")));
}

TEST(SceneId, ChangesWithEveryValue) {
  const std::string base(full_document());
  for (const auto& [from, to] :
       std::vector<std::pair<std::string, std::string>>{{"[4,5,9]", "[4,5,9.0000000000000018]"},
                                                        {"\"seed\": 0", "\"seed\": 1"},
                                                        {"\"k\": 6", "\"k\": 7"},
                                                        {"\"radius\": 1", "\"radius\": 2"},
                                                        {"[0,2,1, 0,1,3", "[2,1,0, 0,1,3"},
                                                        {"\"shadow\": false", "\"shadow\": true"}}) {
    EXPECT_NE(id(base), id(replaced(base, from, to))) << from;
  }
}

TEST(CompileKey, IgnoresTheViewAndNothingElse) {
  const std::string base(full_document());
  EXPECT_EQ(key(base), key(replaced(base, "[4,5,9]", "[4,5,8]")));
  EXPECT_EQ(key(base), key(replaced(base, "\"width\": 1280", "\"width\": 12")));
  EXPECT_EQ(key(base), key(replaced(base, "\"seed\": 0", "\"seed\": 1")));
  EXPECT_NE(key(base), key(replaced(base, "\"radius\": 1", "\"radius\": 2")));
  EXPECT_NE(key(base), key(replaced(base, "\"intensity\": 9", "\"intensity\": 8")));
  EXPECT_NE(key(base), key(replaced(base, "\"ambient\": 0.12", "\"ambient\": 0.13")));
  EXPECT_NE(key(base), key(replaced(base, "#87a9ff", "#87a9fe")));
}

}  // namespace
}  // namespace tilelight
