// SPDX-License-Identifier: Apache-2.0
// The batches of trace_rays.h, for every instruction set.
#include "renderer/base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/trace/trace_rays_simd.cpp"
#include <hwy/foreach_target.h>

#include "renderer/trace/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {

void trace_closest_rays(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<Hit> hits) {
  trace_packets<PacketWalk<false>>(scene, rays, hits,
                                   [&](size_t i) HWY_ATTR { hits[i] = Walk<false>(scene, rays[i]).run(); });
}

void trace_any_rays(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<uint8_t> is_blocked) {
  trace_packets<PacketWalk<true>>(
      scene, rays, is_blocked, [&](size_t i) HWY_ATTR { is_blocked[i] = Walk<true>(scene, rays[i]).run().is_hit(); });
}

void trace_body_ray(const CompiledScene& scene, uint32_t body, const Ray& ray, Hit& hit) {
  hit = Walk<false>(scene, {ray}).run_body(body);
}

}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tilelight {

HWY_EXPORT(trace_closest_rays);
HWY_EXPORT(trace_any_rays);
HWY_EXPORT(trace_body_ray);

void trace_closest(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<Hit> hits) {
  HWY_DYNAMIC_DISPATCH(trace_closest_rays)(scene, rays, hits);
}

void trace_any(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<uint8_t> is_blocked) {
  HWY_DYNAMIC_DISPATCH(trace_any_rays)(scene, rays, is_blocked);
}

Hit trace_body(const CompiledScene& scene, uint32_t body, const Ray& ray) {
  Hit hit;
  HWY_DYNAMIC_DISPATCH(trace_body_ray)(scene, body, ray, hit);
  return hit;
}

}  // namespace tilelight
#endif
