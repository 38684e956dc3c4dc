// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/naive_rays.h"

#include "renderer/trace/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/bench/naive_rays_simd.cpp"
#include <hwy/foreach_target.h>

#include "renderer/trace/walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {

void naive_closest_rays(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<Hit> hits) {
  for (size_t i = 0; i < rays.size(); ++i) hits[i] = Walk<false, Decide::naively>(scene, rays[i]).run();
}

void naive_any_rays(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<uint8_t> is_blocked) {
  for (size_t i = 0; i < rays.size(); ++i) is_blocked[i] = Walk<true, Decide::naively>(scene, rays[i]).run().is_hit();
}

}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tilelight {

HWY_EXPORT(naive_closest_rays);
HWY_EXPORT(naive_any_rays);

void naive_closest(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<Hit> hits) {
  HWY_DYNAMIC_DISPATCH(naive_closest_rays)(scene, rays, hits);
}

void naive_any(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<uint8_t> is_blocked) {
  HWY_DYNAMIC_DISPATCH(naive_any_rays)(scene, rays, is_blocked);
}

}  // namespace tilelight
#endif
