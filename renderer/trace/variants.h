// SPDX-License-Identifier: Apache-2.0
// The kernel variants, one instantiation file each, so that they compile side by side.
#pragma once

#include "renderer/trace/tile_job.h"

namespace tilelight {

void run_local(const TileJob& job);
void run_local_shadows(const TileJob& job);
void run_mirrors(const TileJob& job);
void run_mirrors_shadows(const TileJob& job);
void run_glass(const TileJob& job);
void run_glass_shadows(const TileJob& job);

}  // namespace tilelight
