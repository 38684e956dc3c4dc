// SPDX-License-Identifier: Apache-2.0
// Whole numbers, so lanes give what place_sample gives; the loops are plain, and the compiler makes the lanes.
#include <type_traits>

#include "renderer/base/simd_targets.h"
#include "renderer/trace/pixel_filter.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/trace/place_cell_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {

// By the box filter, to columns that have room for all. width: of the rectangle, known to the compiler or not.
template <class Width>
HWY_INLINE void place_rows(const TileRect& rect, Width width, uint32_t seed, uint32_t index, double* HWY_RESTRICT to_x,
                           double* HWY_RESTRICT to_y) {
  const int count = width * (rect.y1 - rect.y0);
  for (int i = 0; i < count; ++i) {
    const int x = rect.x0 + i % width, y = rect.y0 + i / width;
    const SamplePoint p = sample_point(x, y, seed, index);
    to_x[i] = x + p.x, to_y[i] = y + p.y;
  }
}

void place_box(const TileRect& rect, uint32_t seed, uint32_t index, double* to_x, double* to_y) {
  const int width = rect.x1 - rect.x0;
  if (width == kCellPx) return place_rows(rect, std::integral_constant<int, kCellPx>(), seed, index, to_x, to_y);
  place_rows(rect, width, seed, index, to_x, to_y);
}

}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tilelight {

HWY_EXPORT(place_box);

void place_cell(const RenderSpec& spec, const TileRect& rect, uint32_t index, ImagePoints& points) {
  size_t at = points.size();
  points.x.resize(at + static_cast<size_t>(rect.pixel_count()));
  points.y.resize(points.x.size());
  if (spec.filter == PixelFilter::box && !is_tessellated(spec)) {
    HWY_DYNAMIC_DISPATCH(place_box)(rect, spec.seed, index, points.x.data() + at, points.y.data() + at);
    return;
  }
  for_each_pixel(rect, [&](int x, int y) {
    const SamplePoint p = place_sample(spec, x, y, index);
    points.x[at] = x + p.x, points.y[at] = y + p.y;
    ++at;
  });
}

}  // namespace tilelight
#endif
