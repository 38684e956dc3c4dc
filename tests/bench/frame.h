// SPDX-License-Identifier: Apache-2.0
// A frame by the renderer's own kernels, without what goes on around them: no passes, no error map, no picture.
#pragma once

#include "renderer/compile/compile.h"
#include "renderer/film/film.h"
#include "renderer/schedule/tile_pool.h"

namespace tilelight::bench {

// One sample of every pixel, by the kernel that the plan chooses, added to the film. REQUIRES: a film of the view's
// size with room for a sample.
void render_frame(const CompiledScene& scene, const ViewPlan& plan, TilePool& pool, Film& film);

}  // namespace tilelight::bench
