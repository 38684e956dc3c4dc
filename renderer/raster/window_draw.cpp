// SPDX-License-Identifier: Apache-2.0
#include "renderer/raster/window_draw.h"

#include <algorithm>
#include <map>

#include "renderer/trace/intersect.h"
#include "renderer/trace/pixel_filter.h"

namespace tilelight {
namespace {

constexpr uint32_t kMostLayers = 16;  // 600 KiB of windows
constexpr int kCellsAcross = kWindowPx / kCellPx;

// The hits of the samples that the layers hold: of each cell of the window, from its first sample on.
class WindowHits final : public FirstHits {
 public:
  WindowHits(const CompiledScene& scene, int x0, int y0, std::span<const VisibleWindow> layers,
             std::span<const RasterPrim* const> prims)
      : scene_(scene), x0_(x0), y0_(y0), layers_(layers), prims_(prims) {}

  uint32_t& first_sample(int x, int y) { return first_[cell(x, y)]; }

  SamplePoint place(int x, int y, uint32_t sample) const override {
    const VisibleWindow& layer = layer_of(x, y, sample);
    const size_t at = VisibleWindow::at(x - x0_, y - y0_);
    return {layer.x[at] / kSubpixels - x, layer.y[at] / kSubpixels - y};
  }
  Hit at(int x, int y, uint32_t sample, const Ray& ray) const override {
    const uint32_t owner = layer_of(x, y, sample).owner[VisibleWindow::at(x - x0_, y - y0_)];
    if (owner == kNone) return {};
    return hit_of(scene_, prims_[owner]->body, prims_[owner]->prim, ray);
  }

 private:
  const VisibleWindow& layer_of(int x, int y, uint32_t sample) const { return layers_[sample - first_[cell(x, y)]]; }
  size_t cell(int x, int y) const {
    return static_cast<size_t>((y - y0_) / kCellPx * kCellsAcross + (x - x0_) / kCellPx);
  }

  const CompiledScene& scene_;
  const int x0_, y0_;
  const std::span<const VisibleWindow> layers_;
  const std::span<const RasterPrim* const> prims_;
  std::array<uint32_t, static_cast<size_t>(kCellsAcross) * kCellsAcross> first_{};
};

void place_samples(const RenderSpec& spec, std::span<const CellWork> cells, uint32_t step, int x0, int y0,
                   VisibleWindow& layer) {
  layer.clear();
  for (const CellWork& cell : cells) {
    if (step >= cell.count) continue;
    for_each_pixel(cell.rect, [&](int x, int y) {
      const SamplePoint p = place_sample(spec, x, y, cell.first + step);
      const size_t at = VisibleWindow::at(x - x0, y - y0);
      layer.x[at] = (x + p.x) * kSubpixels;
      layer.y[at] = (y + p.y) * kSubpixels;
    });
  }
}

// To the face of a box, or beside it to its rim, where the ray is nearest to that. The box is about the origin.
double distance_to_face(const Vec3& half, uint32_t face, const LocalRay& ray) {
  const int axis = static_cast<int>(face / 2);
  const double t = ((face % 2 ? half[axis] : -half[axis]) - ray.origin[axis]) / ray.direction[axis];
  const Vec3 at = ray.origin + t * ray.direction;
  if (glm::all(glm::lessThanEqual(glm::abs(at), (1.0 + 0x1p-20) * half + 0x1p-300))) return t;
  const Vec3 reach = glm::clamp(at, -half, half);  // not a number, where the ray runs along the face: its middle
  const Vec3 rim = glm::mix(Vec3(0.0), reach, glm::equal(reach, reach));
  return glm::dot(rim - ray.origin, ray.direction) / glm::dot(ray.direction, ray.direction);
}

// Draws `steps` samples of the cells, from each one's first on.
void draw_window(const RasterScene& raster, const WindowFinder& finder, const TileJob& job, int x, int y,
                 std::vector<CellWork> cells, std::span<VisibleWindow> layers) {
  const int x0 = x * kWindowPx, y0 = y * kWindowPx;
  for (uint32_t step = 0; step < layers.size(); ++step)
    place_samples(raster.plan().view.render, cells, step, x0, y0, layers[step]);
  const std::span<const RasterPrim* const> prims = finder.find(x, y, layers);
  WindowHits hits(raster.scene(), x0, y0, layers, prims);
  for (const CellWork& cell : cells) hits.first_sample(cell.rect.x0, cell.rect.y0) = cell.first;
  TileJob part = job;
  part.cells = cells;
  part.first_hits = &hits;
  part.counts->is_complete = false;  // of this window
  kernel_of(raster.plan().variant)(part);
}

}  // namespace

void draw_windows(const RasterScene& raster, const WindowFinder& finder, const TileJob& job) {
  std::map<std::pair<int, int>, std::vector<CellWork>> windows;  // by row and column
  uint32_t most = 0;
  for (const CellWork& cell : job.cells) {
    windows[{cell.rect.y0 / kWindowPx, cell.rect.x0 / kWindowPx}].push_back(cell);
    most = std::max(most, cell.count);
  }
  std::vector<VisibleWindow> layers(std::min(most, kMostLayers));
  for (const auto& [place, cells] : windows) {
    for (uint32_t first = 0; first < most; first += kMostLayers) {
      std::vector<CellWork> part;
      uint32_t longest = 0;
      for (const CellWork& cell : cells) {
        if (first >= cell.count) continue;
        part.push_back({cell.rect, cell.first + first, std::min(cell.count - first, kMostLayers)});
        longest = std::max(longest, part.back().count);
      }
      if (part.empty()) continue;
      draw_window(raster, finder, job, place.second, place.first, part, std::span(layers).first(longest));
      if (!job.counts->is_complete) return;
    }
  }
}

Hit hit_of(const CompiledScene& scene, uint32_t index, uint32_t prim, const Ray& ray) {
  const CompiledBody& body = scene.bodies[index];
  const LocalRay local = to_local(body, ray);
  Hit hit;
  hit.body = index;
  hit.prim = prim;
  if (body.kind == BodyKind::box) {
    hit.t = distance_to_face(body.half, prim, local);
  } else if (body.kind == BodyKind::plane) {
    hit.t = -local.origin.y / local.direction.y;
  } else {
    double shift = 0.0;
    const Vec3 moved = moved_origin(local, shift);
    const auto& tri = body.mesh->triangles[prim];
    const auto corner = [&](int i) { return body.mesh->positions[tri[static_cast<size_t>(i)]]; };
    TriangleHit found{0.0, 1.0 / 3.0, 1.0 / 3.0};  // of a triangle that the ray sees edge on, its middle
    intersect_triangle(corner(0), corner(1), corner(2), moved, Shear(local.direction), found, true);
    const double b0 = std::max(found.b0, 0.0), b1 = std::max(found.b1, 0.0),
                 b2 = std::max(1.0 - found.b0 - found.b1, 0.0);
    const bool is_beside = found.b0 < 0.0 || found.b1 < 0.0 || found.b0 + found.b1 > 1.0;
    hit.t = shift + found.t;  // not asked for: a mesh's place is known by its weights
    hit.b0 = is_beside ? b0 / (b0 + b1 + b2) : found.b0;
    hit.b1 = is_beside ? b1 / (b0 + b1 + b2) : found.b1;
  }
  return hit;
}

}  // namespace tilelight
