// SPDX-License-Identifier: Apache-2.0
// bench_rays --baseline textbook: the way of the textbooks. Moeller and Trumbore 1997 in float with a fixed epsilon,
// every triangle of every mesh whose bounding sphere the ray meets; no tree.
#pragma once

#include <string>

#include "renderer/schedule/tile_pool.h"

namespace tilelight::bench {

// Prints a table for a scene of meshes: a sample of the rays of a Whitted frame, ours and theirs in turn. Returns a
// JSON object of the same figures.
std::string compare_with_textbook(const std::string& name, const std::string& document, TilePool& pool, int rounds);

}  // namespace tilelight::bench
