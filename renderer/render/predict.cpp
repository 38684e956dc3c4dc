// SPDX-License-Identifier: Apache-2.0
#include "renderer/render/predict.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "renderer/render/pass_schedule.h"
#include "renderer/trace/tile_job.h"

namespace tilelight {
namespace {

int64_t trace(const CompiledScene& scene, const ViewPlan& plan, const MediaSet& eye_media, const TileRect& rect) {
  TileCounts counts;
  TileJob job;
  job.scene = &scene;
  job.plan = &plan;
  job.eye_media = &eye_media;
  job.rect = rect;
  job.counts = &counts;
  kernel_of(plan.variant)(job);
  return counts.primary + counts.shadow + counts.reflected + counts.refracted;
}

// The same picture in about a thousand pixels: each is a cell that stands for many, with one random point in it.
ViewPlan in_cells(const ViewPlan& plan) {
  constexpr int kCells = 1024;  // an error of 1/32 where the cost of a sample scatters as much as its mean
  ViewPlan out = plan;
  const ImageSpec& full = plan.view.image;
  ImageSpec& cells = out.view.image;
  const double shrink = std::min(1.0, std::sqrt(kCells / (static_cast<double>(full.width) * full.height)));
  cells.width = std::clamp(static_cast<int>(std::lround(full.width * shrink)), 1, kCells);
  cells.height = std::clamp(static_cast<int>(std::lround(full.height * shrink)), 1, kCells);
  out.eye.step_x = plan.eye.step_x * (static_cast<double>(full.width) / cells.width);
  out.eye.step_y = plan.eye.step_y * (static_cast<double>(full.height) / cells.height);
  return out;
}

double rays_per_sample(const CompiledScene& scene, const ViewPlan& plan, const MediaSet& eye_media) {
  const ViewPlan cells = in_cells(plan);
  const ImageSpec& image = cells.view.image;
  const TileRect whole{0, 0, image.width, image.height};
  return static_cast<double>(trace(scene, cells, eye_media, whole)) / (static_cast<double>(image.width) * image.height);
}

// Rays of neighbouring pixels go the same ways, so the price of a ray is asked of whole blocks of pixels, spread over
// the image, and with warm caches: a render comes back to a tile sample after sample.
double ms_per_ray(const CompiledScene& scene, const ViewPlan& plan, const MediaSet& eye_media) {
  constexpr int kColumns = 4, kRows = 3, kBlockPx = 16;
  const ImageSpec& image = plan.view.image;
  double ms = 0.0;
  int64_t rays = 0;
  for (int i = 0; i < kColumns * kRows; ++i) {
    const int x = image.width * (2 * (i % kColumns) + 1) / (2 * kColumns);
    const int y = image.height * (2 * (i / kColumns) + 1) / (2 * kRows);
    const TileRect block{x, y, std::min(x + kBlockPx, image.width), std::min(y + kBlockPx, image.height)};
    trace(scene, plan, eye_media, block);
    const auto start = std::chrono::steady_clock::now();
    rays += trace(scene, plan, eye_media, block);
    ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  return ms / static_cast<double>(rays);
}

}  // namespace

CostPrediction predict_cost(const CompiledScene& scene, const ViewPlan& plan, int threads) {
  const MediaSet eye_media = media_at_eye(scene, plan);
  const ImageSpec& image = plan.view.image;
  const double samples = static_cast<double>(image.width) * image.height * PassSchedule(plan.view.render).samples();
  const double rays = samples * rays_per_sample(scene, plan, eye_media);
  CostPrediction cost;
  cost.mrays = 1e-6 * rays;
  cost.cpu_ms = rays * ms_per_ray(scene, plan, eye_media);
  cost.elapsed_ms = cost.cpu_ms / std::max(1, threads);
  if (const auto& time_ms = plan.view.render.time_ms; time_ms && *time_ms < cost.elapsed_ms) {
    const double done = *time_ms / cost.elapsed_ms;
    cost = {cost.mrays * done, cost.cpu_ms * done, *time_ms};
  }
  return cost;
}

}  // namespace tilelight
