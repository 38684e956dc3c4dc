// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/bench_scene.h"

#include <nlohmann/json.hpp>

namespace tilelight::bench {

using Json = nlohmann::ordered_json;

std::string bench_scene(int detail) {
  Json objects = Json::array();
  const char* back[] = {"rook", "knight", "bishop", "queen", "king", "bishop", "knight", "rook"};
  for (int side = 0; side < 2; ++side) {
    for (int file = 0; file < 8; ++file) {
      const auto piece = [&](const char* name, double rank) {
        objects.push_back({{"type", "chess_piece"},
                           {"piece", name},
                           {"color", side ? "black" : "white"},
                           {"detail", detail},
                           {"material", side ? "black" : "white"},
                           {"position", {file - 3.5, 0.0, side ? -rank : rank}}});
      };
      piece(back[file], 3.5);
      piece("pawn", 2.5);
    }
  }
  objects.push_back({{"type", "mesh"}, {"mesh", "table"}, {"material", "table"}});
  const auto material = [](double grey) {
    return Json{{"diffuse", grey}, {"specular", 0.4}, {"shininess", 60}, {"reflection", 0.3}};
  };
  const Json scene = {
      {"camera", {{"position", {7.5, 5.4, 12.2}}, {"target", {0.0, 0.1, 0.5}}, {"fov_y_deg", 30}}},
      {"image", {{"width", 1280}, {"height", 720}}},
      {"render", {{"samples", 1}, {"max_depth", 3}, {"terminator", "exact"}}},
      {"ambient", 0.12},
      {"lights",
       {{{"type", "point"}, {"position", {-5.5, 8.2, 7.0}}, {"intensity", 15}},
        {{"type", "point"}, {"position", {6.0, 5.5, -9.0}}, {"intensity", 8}}}},
      {"materials", {{"white", material(0.8)}, {"black", material(0.1)}, {"table", material(0.4)}}},
      {"meshes",
       {{"table", {{"positions", {-8, 0, -8, 8, 0, -8, 8, 0, 8, -8, 0, 8}}, {"indices", {0, 2, 1, 0, 3, 2}}}}}},
      {"objects", objects}};
  return scene.dump();
}

int detail_of(char size) { return size == 's' ? 18 : size == 'm' ? 100 : 512; }

}  // namespace tilelight::bench
