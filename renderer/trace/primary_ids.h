// SPDX-License-Identifier: Apache-2.0
// What the first sample of every pixel sees, by the fast renderer's own traversal: for comparisons with other methods.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/compile/compile.h"

namespace tilelight {

// width * height ids, row by row: (index into make_bodies' list << 32) | primitive; all ones where nothing is hit.
std::vector<uint64_t> primary_ids(const CompiledScene& scene, const ViewPlan& plan);

}  // namespace tilelight
