// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "renderer/scene/parse.h"

namespace tilelight {

// White's place at the table, a little to the right and above; the key light from the right behind the viewer. Written
// as text, because people go on editing it.
std::string chess_scene_json(std::string_view fen, int detail) {
  using nlohmann::json;
  const std::string fen_json = json(fen).dump(-1, ' ', false, json::error_handler_t::replace);
  return R"({
  "tilelight": 1,
  "camera": {"type": "perspective", "position": [3.2, 7.6, 11.6], "target": [-0.35, -0.1, 1.2], "fov_y_deg": 38},
  "background": {"bottom": [0.3, 0.29, 0.28], "top": [0.62, 0.68, 0.76]},
  "ambient": 0.16,
  "lights": [
    {"type": "directional", "direction": [-1.2, -2, -0.9], "color": [1, 0.96, 0.9], "intensity": 0.85},
    {"type": "directional", "direction": [1, -0.8, -0.6], "color": [0.85, 0.92, 1], "intensity": 0.25, "shadow": false}
  ],
  "objects": [
    {"type": "chess_position", "fen": )" +
         fen_json + R"(, "detail": )" + std::to_string(detail) + R"(}
  ]
}
)";
}

}  // namespace tilelight
