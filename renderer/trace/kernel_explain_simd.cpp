// SPDX-License-Identifier: Apache-2.0
// Kernel variant "explain".
#include "renderer/trace/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/trace/kernel_explain_simd.cpp"
#include <hwy/foreach_target.h>

#include "renderer/trace/render_tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {
void render_explain(const TileJob& job) { render_tile<Abilities{.mirrors = true, .glass = true, .shadows = true, .listens = true}>(job); }
}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "renderer/trace/variants.h"

namespace tilelight {
HWY_EXPORT(render_explain);
void run_explain(const TileJob& job) { HWY_DYNAMIC_DISPATCH(render_explain)(job); }
}  // namespace tilelight
#endif
