// SPDX-License-Identifier: Apache-2.0
#include "renderer/trace/tile_kernel.h"
#include "renderer/trace/variants.h"

namespace tilelight {

void run_glass(const TileJob& job) { TileKernel<Abilities{.mirrors = true, .glass = true}>(job).run(); }

}  // namespace tilelight
