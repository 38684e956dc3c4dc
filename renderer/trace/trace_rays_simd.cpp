// SPDX-License-Identifier: Apache-2.0
// The batches of trace_rays.h, for every instruction set.
#include "renderer/base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/trace/trace_rays_simd.cpp"
#include <hwy/foreach_target.h>

#include "renderer/trace/packet-inl.h"
#include "renderer/trace/place-inl.h"

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

void find_surfaces_here(const CompiledScene& scene, const Ray& ray, uint32_t owner, std::vector<Hit>& found) {
  PlaceSearch(scene, ray, owner, found).run();
}

}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tilelight {

HWY_EXPORT(trace_closest_rays);
HWY_EXPORT(trace_any_rays);
HWY_EXPORT(trace_body_ray);
HWY_EXPORT(find_surfaces_here);

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

void find_surfaces(const CompiledScene& scene, const Vec3& place, const Vec3& direction, uint32_t owner,
                   std::vector<Hit>& found) {
  found.clear();
  HWY_DYNAMIC_DISPATCH(find_surfaces_here)(scene, {place, direction, {}, Coincident::none}, owner, found);
}

}  // namespace tilelight
#endif
