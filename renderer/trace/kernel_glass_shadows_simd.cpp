// SPDX-License-Identifier: Apache-2.0
// Kernel variant "glass+shadows".
#include "renderer/trace/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/trace/kernel_glass_shadows_simd.cpp"
#include <hwy/foreach_target.h>

#include "renderer/trace/render_tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {
void render_glass_shadows(const TileJob& job) { render_tile<Abilities{.mirrors = true, .glass = true, .shadows = true}>(job); }
}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "renderer/trace/variants.h"

namespace tilelight {
HWY_EXPORT(render_glass_shadows);
void run_glass_shadows(const TileJob& job) { HWY_DYNAMIC_DISPATCH(render_glass_shadows)(job); }
}  // namespace tilelight
#endif
