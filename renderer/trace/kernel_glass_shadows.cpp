// SPDX-License-Identifier: Apache-2.0
#include "renderer/trace/tile_kernel.h"
#include "renderer/trace/variants.h"

namespace tilelight {

void run_glass_shadows(const TileJob& job) {
  TileKernel<Abilities{.mirrors = true, .glass = true, .shadows = true}>(job).run();
}

}  // namespace tilelight
