// SPDX-License-Identifier: Apache-2.0
// Limits: what a request may ask for. Checked before memory is taken; published by the server.
#pragma once

#include <cstdint>

namespace tilelight {

// Of the text that holds a chess position: for a game's tags and moves around it.
inline constexpr int64_t kMostFenCharacters = 4'096;

struct Limits {
  int64_t bytes = 16 << 20;  // of a scene document
  int json_depth = 64;
  int64_t json_values = 1'000'000;  // values of a document; 40 bytes each while it is read. Numbers in lists are free
  int64_t objects = 10'000;
  int64_t lights = 1'000;
  int64_t materials = 10'000;
  int64_t mesh_triangles = 2'000'000;        // in the meshes of one scene, before instancing
  int64_t instanced_triangles = 50'000'000;  // after instancing
  int64_t pixels = 16'777'216;
  int image_side = 65'537;  // pixels
  int samples = 4'096;      // a pixel
  int max_depth = 1'000;
  int ray_budget = 65'536;  // rays a pixel sample; 300 bytes each and thread while the sample is traced
  double time_ms = 600'000.0;
};

}  // namespace tilelight
