// SPDX-License-Identifier: Apache-2.0
// Meshes whose numbers stand in lists of three: the same mesh as flat, and exact complaints where the lists are not.
#include <gtest/gtest.h>

#include <algorithm>

#include "scene_support.h"

namespace tilelight {
namespace {

using test::errors_of;
using test::parsed;

std::string mesh(std::string_view members) {
  return R"({"meshes": {"m": {)" + std::string(members) + R"(}}, "objects": [{"type": "mesh", "mesh": "m"}]})";
}

constexpr std::string_view kFlat = R"("positions": [0,0,0, 1,0,0, 0,1,0.5, -0.0,1e-3,1], "indices": [0,2,1, 0,1,3],
                                      "normals": [0,0,1, 0,0,1, 0,0,1, 0,1,0])";
constexpr std::string_view kLists = R"("positions": [[0,0,0], [1,0,0], [0,1,0.5], [-0.0,1e-3,1]],
                                       "indices": [[0,2,1], [0,1,3]],
                                       "normals": [[0,0,1], [0,0,1], [0,0,1], [0,1,0]])";

TEST(MeshLists, MeanWhatFlatOnesMean) {
  const ParsedScene flat = parsed(mesh(kFlat)), lists = parsed(mesh(kLists));
  EXPECT_EQ(flat.scene, lists.scene);
  EXPECT_EQ(flat.scene_id, lists.scene_id);
  EXPECT_EQ(flat.compile_key, lists.compile_key);
  ASSERT_EQ(lists.scene.meshes[0].positions.size(), 4u);
  EXPECT_EQ(lists.scene.meshes[0].positions[2], Vec3(0, 1, 0.5));
  EXPECT_EQ(lists.scene.meshes[0].indices, (std::vector<uint32_t>{0, 2, 1, 0, 1, 3}));
}

TEST(MeshLists, MayDifferFromMemberToMember) {
  const ParsedScene mixed = parsed(mesh(R"("positions": [[0,0,0], [1,0,0], [0,1,0]], "indices": [0,1,2])"));
  const ParsedScene flat = parsed(mesh(R"("positions": [0,0,0, 1,0,0, 0,1,0], "indices": [0,1,2])"));
  EXPECT_EQ(mixed.scene_id, flat.scene_id);
}

struct Bad {
  const char *members, *code, *pointer, *says;
};
constexpr const char* kTriangle = R"("positions": [[0,0,0], [1,0,0], [0,1,0]], )";
const Bad kBads[] = {
    {R"("positions": [[0,0,0], [1,0], [0,1,0]], "indices": [0,1,2])", "wrong_length", "/meshes/m/positions/1",
     "found a list of 2 numbers; allowed: 3 numbers"},
    {R"("positions": [[0,0,0], [1,0,0,0], [0,1,0]], "indices": [0,1,2])", "wrong_length", "/meshes/m/positions/1",
     "found a list of 4 numbers; allowed: 3 numbers"},
    {R"("positions": [[1,2], [1,0,0], [0,1,0]], "indices": [0,1,2])", "wrong_length", "/meshes/m/positions/0",
     "found a list of 2 numbers"},
    {R"("positions": [[0,0,0], [1,0,0], [0,1,0], 5], "indices": [0,1,2])", "wrong_type", "/meshes/m/positions/3",
     "found 5; allowed: 3 numbers"},
    {R"("positions": [0,0,0, [1,0,0], 0,1,0], "indices": [0,1,2])", "wrong_type", "/meshes/m/positions/3",
     "found a list of 3 numbers; allowed: a number"},
    {R"("positions": [[0,0,0], [1,"0",0], [0,1,0]], "indices": [0,1,2])", "wrong_type", "/meshes/m/positions/1/1",
     "found \"0\" (a string)"},
    {R"("positions": [[0,0,0], [1,[0],0], [0,1,0]], "indices": [0,1,2])", "wrong_type", "/meshes/m/positions/1/1",
     "found a list of 1 number"},
    {R"("positions": [[0,0,0], [1,1e31,0], [0,1,0]], "indices": [0,1,2])", "out_of_range", "/meshes/m/positions/1/1",
     "found 1e+31"},
    {R"("positions": [[0,0,0], [1,1e999,0], [0,1,0]], "indices": [0,1,2])", "out_of_range", "/meshes/m/positions/1/1",
     "1e999"},
    {R"("positions": [[[0,0,0], [1,0,0], [0,1,0]]], "indices": [0,1,2])", "wrong_type", "/meshes/m/positions/0/0",
     "found a list of 3 numbers"},
    {R"("positions": [[]], "indices": [0,1,2])", "wrong_length", "/meshes/m/positions/0", "found an empty list"},
    {R"("positions": [{}], "indices": [0,1,2])", "wrong_type", "/meshes/m/positions/0", "found an object"},
    {R"("positions": [[0,0,0], null, [0,1,0]], "indices": [0,1,2])", "wrong_type", "/meshes/m/positions/1", "null"}};

class BadLists : public testing::TestWithParam<Bad> {};
TEST_P(BadLists, AreRefusedAtTheirPlace) {
  const auto errors = errors_of(mesh(GetParam().members));
  const bool found = std::any_of(errors.begin(), errors.end(), [](const SceneError& e) {
    return e.code == GetParam().code && e.pointer == GetParam().pointer && e.line == 1 && e.column > 1 &&
           e.detail.find(GetParam().says) != std::string::npos;
  });
  EXPECT_TRUE(found) << GetParam().members << "\n" << test::listed(errors);
  EXPECT_LE(errors.size(), 3u) << test::listed(errors);
}
INSTANTIATE_TEST_SUITE_P(MeshLists, BadLists, testing::ValuesIn(kBads));

TEST(MeshLists, SayWhichIndexOfWhichTriangleIsWrong) {
  for (const auto& [list, pointer] :
       {std::pair(R"([[0,1,2], [0,1,3]])", "/meshes/m/indices/1/2"),
        std::pair(R"([[0,-1,2]])", "/meshes/m/indices/0/1"), std::pair(R"([[0,1,1.5]])", "/meshes/m/indices/0/2")}) {
    const auto errors = errors_of(mesh(std::string(kTriangle) + "\"indices\": " + list));
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_EQ(errors[0].pointer, pointer);
    EXPECT_EQ(errors[0].code, "out_of_range");
  }
}

TEST(MeshLists, TellAFaceOfFourCornersByItsPlace) {
  const auto errors = errors_of(mesh(std::string(kTriangle) + R"("indices": [[0,1,2], [0,1,2,0]])"));
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].pointer, "/meshes/m/indices/1");
}

TEST(MeshLists, AreNowhereElse) {
  for (const char* position : {"[[1,2,3]]", "[[1,2,3],[1,2,3],[1,2,3]]"}) {
    const std::string document =
        R"({"camera": {"position": )" + std::string(position) + R"(}, "objects": [{"type": "cube"}]})";
    EXPECT_EQ(test::error_of(document, "wrong_type").pointer, "/camera/position/0");
  }
  EXPECT_EQ(errors_of(R"({"objects": [[1,2,3]]})")[0].pointer, "/objects/0");
  EXPECT_EQ(test::error_of(R"({"objects": [{"type": "cube", "matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}]})",
                           "wrong_type")
                .pointer,
            "/objects/0/matrix/0");
}

TEST(MeshLists, OfYourOwnMayHoldAnything) {
  parsed(R"({"objects": [{"type": "cube"}], "extras": [[1,2,3],[4,5,6],[7,8]], "x-b": [[1,2,3],4], "x-c": [[[1,2,3]]],
             "x-d": [[1,2,3],{}], "x-e": [1,[1,2,3]], "x-f": [[1,2,3]]})");
}

// A list of three costs what its numbers cost, so that it meets the limits that flat ones meet.
TEST(MeshLists, AreNoMoreValuesThanFlatOnes) {
  Limits limits;
  limits.json_values = 20;
  limits.mesh_triangles = 100;
  std::string triangles;
  for (int i = 0; i < 100; ++i) triangles += (i > 0 ? ",[0,1,2]" : "[0,1,2]");
  EXPECT_TRUE(parse_scene(mesh(std::string(kTriangle) + "\"indices\": [" + triangles + "]"), limits));
  const auto errors = errors_of(mesh(std::string(kTriangle) + "\"indices\": [" + triangles + ",[0,1,2]]"), limits);
  EXPECT_EQ(errors[0].code, "limit");
  EXPECT_EQ(errors[0].pointer, "/meshes/m/indices");
  const auto unlike = parse_scene(mesh(std::string(kTriangle) + "\"indices\": [" + triangles + ",\"x\"]"), limits);
  ASSERT_FALSE(unlike);
  EXPECT_EQ(unlike.error().kind, SceneErrors::Kind::too_large);
}

}  // namespace
}  // namespace tilelight
