// SPDX-License-Identifier: Apache-2.0
// bench_rays --peer embree: our tracer and Embree's in turn, on identical triangles and rays.
#pragma once

#include <string>

#include "renderer/schedule/tile_pool.h"

namespace tilelight::bench {

// Prints a table for the scene. Returns a JSON object of the same figures.
std::string compare_with_embree(const std::string& name, const std::string& document, TilePool& pool, int rounds,
                                bool robust);

}  // namespace tilelight::bench
