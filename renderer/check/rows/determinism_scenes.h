// SPDX-License-Identifier: Apache-2.0
// Small scenes that between them use all that a render can do, as JSON.
#pragma once

namespace tilelight::check {

// Glass, mirrors, a checker, both kinds of light, overlapping media, a mesh of many triangles that compiles on several
// threads.
inline constexpr const char* kShowcase = R"({
  "image": {"width": 96, "height": 64}, "render": {"samples": 4},
  "camera": {"position": [1.5, 3.1, 8], "target": [0, 0.7, 0], "fov_y_deg": 38},
  "lights": [{"type": "point", "position": [3, 5, 4], "intensity": 6},
             {"type": "directional", "direction": [-1, -2, -1], "intensity": 0.4}],
  "materials": {"glass": {"diffuse": 0.02, "specular": 0.5, "shininess": 300, "reflection": 0.1, "transmission": 0.85},
                "water": {"diffuse": 0, "transmission": [0.7, 0.9, 0.95], "ior": 1.33, "fresnel": true, "priority": -1},
                "mirror": {"diffuse": 0.1, "specular": 0.6, "reflection": 0.8},
                "tiles": {"diffuse": {"checker": {"a": 0.9, "b": 0.1, "size": 0.5}}, "reflection": 0.1}},
  "meshes": {"tetra": {"positions": [0,0,0, 1,0,0, 0,1,0, 0,0,1], "indices": [0,2,1, 0,1,3, 0,3,2, 1,2,3]}},
  "objects": [{"type": "box", "min": [-4, -1, -4], "max": [4, 0, 4], "material": "tiles"},
              {"type": "plane", "point": [0, -1.5, 0]},
              {"type": "sphere", "center": [0, 1, 0.3], "radius": 1, "material": "glass"},
              {"type": "sphere", "center": [0.6, 0.9, 0.9], "radius": 0.7, "material": "water"},
              {"type": "sphere", "center": [2.3, 1, -1], "radius": 1, "scale": [1, 0.6, 1], "material": "mirror"},
              {"type": "mesh", "mesh": "tetra", "translate": [1.6, 0, 1.4], "scale": [1, 2, 1],
               "rotate_deg": {"axis": [1, 2, 3], "angle": 37}},
              {"type": "chess_piece", "piece": "queen", "position": [-1.9, 0, 0.7], "detail": 160},
              {"type": "chess_piece", "piece": "knight", "position": [-2.7, 0, -1.4], "detail": 16}]})";

// A position of the game, with glass men.
inline constexpr const char* kChess = R"({
  "image": {"width": 96, "height": 64}, "render": {"samples": 1},
  "camera": {"position": [3.2, 6.1, 9.4], "target": [0, 0.3, 0.4], "fov_y_deg": 42},
  "lights": [{"type": "point", "position": [5, 8, 4], "color": [1, 0.95, 0.9], "intensity": 9}],
  "attenuation": {"k": 6},
  "objects": [{"type": "chess_position", "fen": "r1bqkbnr/pppp1ppp/2n5/4p3/2B1P3/5N2/PPPP1PPP/RNBQK2R", "detail": 16,
               "materials": {"white": {"diffuse": 0.05, "specular": 0.6, "reflection": 0.1, "transmission": 0.8}}}]})";

// Lengths from 1e-6 to 1e7, lobes from 0 to 1e6, a light of 1e12, far from the origin.
inline constexpr const char* kExtremes = R"({
  "image": {"width": 96, "height": 64, "exposure": -6}, "render": {"samples": 2, "max_depth": 4},
  "camera": {"position": [1e7, 2, 7], "target": [1e7, 0.6, 0], "fov_y_deg": 50},
  "attenuation": {"mode": "inverse_square", "k": 1e-9},
  "lights": [{"type": "point", "position": [1.00001e7, 2e6, 1e5], "intensity": 1e14},
             {"type": "point", "position": [1e7, 1.000001, 1], "intensity": 1e-3}],
  "materials": {"sharp": {"diffuse": 0.3, "specular": 0.9, "shininess": 1e6, "reflection": 0.4},
                "blunt": {"diffuse": 0.5, "specular": 0.5, "shininess": 0}},
  "objects": [{"type": "sphere", "center": [1e7, -6371000, 0], "radius": 6371000, "material": "blunt"},
              {"type": "sphere", "center": [1e7, 1, 0], "radius": 1, "material": "sharp"},
              {"type": "sphere", "center": [1e7, 1, 1], "radius": 1e-6},
              {"type": "box", "min": [9999997, 0, -2], "max": [9999998.5, 1.5, 0.5], "material": "sharp"},
              {"type": "box", "min": [10000002, 0, 0], "max": [10000002, 2, 2]}]})";

}  // namespace tilelight::check
