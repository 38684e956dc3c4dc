// SPDX-License-Identifier: Apache-2.0
#include "renderer/check/kit/methods.h"

#include <algorithm>
#include <cmath>

#include "renderer/compile/tessellate.h"
#include "renderer/measure/reference.h"
#include "renderer/raster/warnock.h"
#include "renderer/raster/zbuffer.h"
#include "renderer/render/render.h"
#include "renderer/trace/pixel_filter.h"
#include "renderer/trace/trace_rays.h"

namespace tilelight::check {
namespace {

View from_triangles(View view) {
  view.render.tessellate = true;
  return view;
}

}  // namespace

DrawnScene::DrawnScene(const ParsedScene& parsed, TilePool& pool) : pool_(pool) {
  const auto compiled = compile_scene(parsed.scene, pool);
  plan_ = plan_view(*compiled, from_triangles(parsed.view));
  scene_ = drawn_scene(compiled, plan_, pool);
}

std::vector<uint64_t> DrawnScene::ids_by_rays(double dx, double dy) const {
  const ImageSpec& image = plan_.view.image;
  const auto width = static_cast<size_t>(image.width);
  std::vector<uint64_t> ids(width * static_cast<size_t>(image.height), kNothingHit);
  pool_.parallel_for(image.height, Priority::batch, [&](int64_t y) {
    std::vector<BoundedRay> rays(width);
    std::vector<Hit> hits(width);
    for (int x = 0; x < image.width; ++x) {
      const SamplePoint p = place_sample(plan_.view.render, x, static_cast<int>(y), 0);
      const EyeRay ray = eye_ray(plan_.eye, x + p.x + dx, static_cast<double>(y) + p.y + dy);
      rays[static_cast<size_t>(x)].ray = {ray.origin, ray.direction, {}, {}};
    }
    trace_closest(*scene_, rays, hits);
    for (size_t x = 0; x < width; ++x) {
      if (!hits[x].is_hit()) continue;
      ids[static_cast<size_t>(y) * width + x] = surface_id(scene_->bodies[hits[x].body].body, hits[x].prim);
    }
  });
  return ids;
}

std::vector<uint64_t> DrawnScene::ids(Algorithm algorithm) const {
  if (algorithm != Algorithm::zbuffer && algorithm != Algorithm::warnock) return ids_by_rays(0.0, 0.0);
  const ImageSpec& image = plan_.view.image;
  const RasterScene raster(*scene_, plan_, pool_);
  std::unique_ptr<WarnockScene> warnock;
  if (algorithm == Algorithm::warnock) warnock = std::make_unique<WarnockScene>(raster, pool_);
  const int across = (image.width + kWindowPx - 1) / kWindowPx, down = (image.height + kWindowPx - 1) / kWindowPx;
  std::vector<uint64_t> ids(static_cast<size_t>(image.width) * static_cast<size_t>(image.height), kNothingHit);
  pool_.parallel_for(int64_t{across} * down, Priority::batch, [&](int64_t i) {
    const int x = static_cast<int>(i) % across, y = static_cast<int>(i) / across;
    const int x0 = x * kWindowPx, y0 = y * kWindowPx;
    const auto window = std::make_unique<VisibleWindow>();
    place_samples(
        image, x0, y0,
        [&](int px, int py) {
          const SamplePoint p = place_sample(plan_.view.render, px, py, 0);
          return kSubpixels * Vec2(px + p.x, py + p.y);
        },
        *window);
    std::span<const RasterPrim* const> prims;
    if (warnock) {
      prims = warnock->draw(x, y, {window.get(), 1});
    } else {
      prims = raster.in_window(x, y);
      draw_depths(prims, x0, y0, *window);
    }
    const TileRect part{x0, y0, std::min(x0 + kWindowPx, image.width), std::min(y0 + kWindowPx, image.height)};
    for_each_pixel(part, [&](int px, int py) {
      const uint32_t owner = window->owner[VisibleWindow::at(px - x0, py - y0)];
      if (owner == kNone) return;
      ids[static_cast<size_t>(py) * static_cast<size_t>(image.width) + static_cast<size_t>(px)] =
          surface_id(scene_->bodies[prims[owner]->body].body, prims[owner]->prim);
    });
  });
  return ids;
}

std::vector<Beside> DrawnScene::beside() const {
  const std::vector<uint64_t> own = ids_by_rays(0.0, 0.0);
  std::vector<Beside> out(own.size(), Beside::same);
  constexpr double kHalfStep = 0.5 / kSubpixels;
  for (int direction = 0; direction < 9; ++direction) {
    const std::vector<uint64_t> other = ids_by_rays(kHalfStep * (direction % 3 - 1), kHalfStep * (direction / 3 - 1));
    for (size_t i = 0; i < own.size(); ++i) {
      if (own[i] == other[i]) continue;
      out[i] = std::max(out[i], own[i] >> 32 == other[i] >> 32 ? Beside::other_triangle : Beside::other_body);
    }
  }
  return out;
}

void place_samples(const ImageSpec& image, int x0, int y0, const std::function<Vec2(int, int)>& place,
                   VisibleWindow& window) {
  window.clear();
  const TileRect part{x0, y0, std::min(x0 + kWindowPx, image.width), std::min(y0 + kWindowPx, image.height)};
  for_each_pixel(part, [&](int x, int y) {
    const Vec2 p = place(x, y);
    window.x[VisibleWindow::at(x - x0, y - y0)] = p.x;
    window.y[VisibleWindow::at(x - x0, y - y0)] = p.y;
  });
}

}  // namespace tilelight::check
