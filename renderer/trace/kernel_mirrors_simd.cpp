// SPDX-License-Identifier: Apache-2.0
// Kernel variant "mirrors".
#include "renderer/trace/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/trace/kernel_mirrors_simd.cpp"
#include <hwy/foreach_target.h>

#include "renderer/trace/render_tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {
void render_mirrors(const TileJob& job) { render_tile<Abilities{.mirrors = true}>(job); }
}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "renderer/trace/variants.h"

namespace tilelight {
HWY_EXPORT(render_mirrors);
void run_mirrors(const TileJob& job) { HWY_DYNAMIC_DISPATCH(render_mirrors)(job); }
}  // namespace tilelight
#endif
