// SPDX-License-Identifier: Apache-2.0
#include "renderer/raster/method.h"

#include "renderer/raster/line_draw.h"
#include "renderer/raster/raster_work.h"
#include "renderer/raster/warnock.h"
#include "renderer/raster/window_draw.h"
#include "renderer/raster/zbuffer.h"

namespace tilelight {
namespace {

class Raytrace final : public Method {
 public:
  explicit Raytrace(KernelVariant variant) : kernel_(kernel_of(variant)) {}
  void draw(const TileJob& job) const override { kernel_(job); }

 private:
  const Kernel kernel_;
};

class Zbuffer final : public Method, public WindowFinder {
 public:
  Zbuffer(const CompiledScene& scene, const ViewPlan& plan, TilePool& pool, const std::atomic<bool>* stop)
      : raster_(scene, plan, pool, stop) {}
  void draw(const TileJob& job) const override { draw_windows(raster_, *this, job); }
  MethodWork work() const override { return zbuffer_work(raster_); }
  int64_t memory_bytes() const override { return raster_.memory_bytes(); }

  std::span<const RasterPrim* const> find(int x, int y, std::span<VisibleWindow> layers) const override {
    const std::span<const RasterPrim* const> prims = raster_.in_window(x, y);
    for (VisibleWindow& layer : layers) draw_depths(prims, x * kWindowPx, y * kWindowPx, layer);
    return prims;
  }

 private:
  const RasterScene raster_;
};

class Warnock final : public Method, public WindowFinder {
 public:
  Warnock(const CompiledScene& scene, const ViewPlan& plan, TilePool& pool, const std::atomic<bool>* stop)
      : raster_(scene, plan, pool, stop), subdivision_(raster_, pool, stop) {}
  void draw(const TileJob& job) const override { draw_windows(raster_, *this, job); }
  MethodWork work() const override { return warnock_work(raster_, subdivision_); }
  int64_t memory_bytes() const override { return raster_.memory_bytes() + subdivision_.memory_bytes(); }

  std::span<const RasterPrim* const> find(int x, int y, std::span<VisibleWindow> layers) const override {
    return subdivision_.draw(x, y, layers);
  }

 private:
  const RasterScene raster_;
  const WarnockScene subdivision_;
};

class Roberts final : public Method {
 public:
  Roberts(const CompiledScene& scene, const ViewPlan& plan, TilePool& pool, const std::atomic<bool>* stop)
      : spec_(plan.view.render), drawing_(draw_lines(scene, plan, pool, spec_.hidden_lines, stop)), ink_(drawing_) {}
  void draw(const TileJob& job) const override { draw_ink(ink_, spec_, job); }
  MethodWork work() const override { return roberts_work(drawing_); }
  int64_t memory_bytes() const override { return static_cast<int64_t>(drawing_.lines.size() * sizeof(DrawnLine)); }
  std::string lines_svg() const override { return line_drawing_svg(drawing_); }

 private:
  const RenderSpec spec_;
  const LineDrawing drawing_;
  const LineInk ink_;
};

}  // namespace

std::unique_ptr<const Method> make_method(const CompiledScene& scene, const ViewPlan& plan, TilePool& pool,
                                          const std::atomic<bool>* stop) {
  switch (plan.view.render.algorithm) {
    case Algorithm::zbuffer:
      return std::make_unique<Zbuffer>(scene, plan, pool, stop);
    case Algorithm::warnock:
      return std::make_unique<Warnock>(scene, plan, pool, stop);
    case Algorithm::roberts:
      return std::make_unique<Roberts>(scene, plan, pool, stop);
    case Algorithm::raytrace:
      break;
  }
  return std::make_unique<Raytrace>(plan.variant);
}

}  // namespace tilelight
