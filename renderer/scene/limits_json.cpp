// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "renderer/scene/parse.h"

namespace tilelight {

std::string limits_json(const Limits& limits) {
  const nlohmann::ordered_json out = {{"bytes", limits.bytes},
                                      {"json_depth", limits.json_depth},
                                      {"json_values", limits.json_values},
                                      {"fen_characters", kMostFenCharacters},
                                      {"objects", limits.objects},
                                      {"lights", limits.lights},
                                      {"materials", limits.materials},
                                      {"mesh_triangles", limits.mesh_triangles},
                                      {"instanced_triangles", limits.instanced_triangles},
                                      {"pixels", limits.pixels},
                                      {"image_side", limits.image_side},
                                      {"samples", limits.samples},
                                      {"max_depth", limits.max_depth},
                                      {"ray_budget", limits.ray_budget},
                                      {"time_ms", limits.time_ms}};
  return out.dump(2);
}

}  // namespace tilelight
