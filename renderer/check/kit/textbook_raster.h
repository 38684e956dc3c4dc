// SPDX-License-Identifier: Apache-2.0
// Scan conversion as textbooks print it: every corner divided by its w, corners on a coarse grid or none, the smallest
// depth wins. Pure.
#pragma once

#include "renderer/check/kit/methods.h"

namespace tilelight::check {

// A triangle of a compiled scene; boxes have twelve.
struct WorldTriangle {
  uint64_t id = 0;  // as surface_id
  Vec3 corners[3];  // normalised
};
// REQUIRES: boxes and meshes alone.
std::vector<WorldTriangle> triangles_of(const CompiledScene& scene);

struct TextbookRaster {
  double steps_per_px = 0.0;  // corners are rounded to these; 0: they are not
  // Of a depth buffer that holds (far (z - near)) / (z (far - near)) in float, as graphics cards did for decades; scene
  // units. 0: it holds less the nearness, in double.
  double near = 0.0, far = 0.0;
};
// By pixel what its first sample sees, as surface_id. REQUIRES: boxes and meshes alone.
std::vector<uint64_t> textbook_ids(const DrawnScene& drawn, const TextbookRaster& raster);

}  // namespace tilelight::check
