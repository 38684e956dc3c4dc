// SPDX-License-Identifier: Apache-2.0
#include "renderer/trace/eye_rays.h"

#include "renderer/base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/trace/eye_rays_simd.cpp"
#include <hwy/foreach_target.h>

#include "renderer/shade/reals-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {

void aim_rays(const Eye& eye, const ImagePoints& points, std::span<BoundedRay> rays) {
  const bool is_orthographic = eye.projection == Projection::orthographic;
  const auto corner = of<Lanes>(eye.corner), step_x = of<Lanes>(eye.step_x), step_y = of<Lanes>(eye.step_y),
             start = of<Lanes>(eye.start), forward = of<Lanes>(eye.forward);
  const Lanes lead(eye.lead);
  for (size_t first = 0; first < points.size(); first += kLanes) {
    const size_t count = std::min(kLanes, points.size() - first);
    const auto of_points = [&](const std::vector<double>& column) HWY_ATTR {
      if (count == kLanes) return load(&column[first]);
      Gathered some{};
      std::copy_n(&column[first], count, some.at);
      return some.lanes();
    };
    const auto across = corner + of_points(points.x) * step_x + of_points(points.y) * step_y;
    const Gathered3 origin(start + lead * across);
    const Gathered3 direction(is_orthographic ? forward : normalized(forward + across));
    for (size_t i = 0; i < count; ++i) {
      Ray& ray = rays[first + i].ray;
      ray.origin = origin.lane(i), ray.direction = direction.lane(i);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tilelight {

HWY_EXPORT(aim_rays);

void aim_eye_rays(const Eye& eye, const ImagePoints& points, std::span<BoundedRay> rays) {
  HWY_DYNAMIC_DISPATCH(aim_rays)(eye, points, rays);
}

}  // namespace tilelight
#endif
