// SPDX-License-Identifier: Apache-2.0
#include "renderer/render/predict.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "renderer/base/standard_floats.h"
#include "renderer/render/pass_schedule.h"
#include "renderer/trace/tile_job.h"

namespace tilelight {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

int64_t trace(const CompiledScene& scene, const ViewPlan& plan, const EyeMedia& eye_media, const TileRect& rect) {
  TileCounts counts;
  std::vector<CellWork> cells;
  for_each_cell(rect, [&](const TileRect& cell) { cells.push_back({cell}); });
  kernel_of(plan.variant)({.scene = &scene, .plan = &plan, .eye_media = &eye_media, .cells = cells, .counts = &counts});
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

// A stride that visits all of `count` places and soon has been everywhere: near the golden ratio, coprime to count.
int golden_stride(int count) {
  int stride = std::max(1, static_cast<int>(std::lround(0.618 * count)));
  while (std::gcd(stride, count) != 1) ++stride;
  return stride;
}

struct Price {
  double rays_per_sample = 0.0, ms_per_ray = 0.0;
};

// One sample a cell, all over the image, until all are traced or the time is over.
Price ask_cells(const CompiledScene& scene, const ViewPlan& plan) {
  constexpr double kEnoughMs = 100.0;
  constexpr int kAtLeast = 8;
  const ViewPlan cells = in_cells(plan);
  const EyeMedia eye_media(scene, cells);
  const int width = cells.view.image.width, count = width * cells.view.image.height, stride = golden_stride(count);
  const auto start = Clock::now();
  int64_t rays = 0, place = 0;
  int asked = 0;
  for (; asked < count && (asked < kAtLeast || ms_since(start) < kEnoughMs);
       ++asked, place = (place + stride) % count) {
    const int x = static_cast<int>(place % width), y = static_cast<int>(place / width);
    rays += trace(scene, cells, eye_media, {x, y, x + 1, y + 1});
  }
  return {static_cast<double>(rays) / asked, ms_since(start) / static_cast<double>(rays)};
}

// Rays of neighbouring pixels go the same ways, so the price of a ray is asked of whole blocks of pixels, spread over
// the image, and with warm caches: a render comes back to a tile sample after sample.
double ask_blocks(const CompiledScene& scene, const ViewPlan& plan) {
  constexpr int kColumns = 4, kRows = 3, kBlockPx = 16;
  const ImageSpec& image = plan.view.image;
  const EyeMedia eye_media(scene, plan);
  double ms = 0.0;
  int64_t rays = 0;
  for (int i = 0; i < kColumns * kRows; ++i) {
    const int x = image.width * (2 * (i % kColumns) + 1) / (2 * kColumns);
    const int y = image.height * (2 * (i / kColumns) + 1) / (2 * kRows);
    const TileRect block{x, y, std::min(x + kBlockPx, image.width), std::min(y + kBlockPx, image.height)};
    trace(scene, plan, eye_media, block);
    const auto start = Clock::now();
    rays += trace(scene, plan, eye_media, block);
    ms += ms_since(start);
  }
  return ms / static_cast<double>(rays);
}

}  // namespace

CostPrediction predict_cost(const CompiledScene& scene, const ViewPlan& plan, int threads) {
  const StandardFloats floats;
  constexpr double kManyRays = 50.0;  // a sample's; then they are scattered and many enough to tell their own price
  Price price = ask_cells(scene, plan);
  if (price.rays_per_sample < kManyRays) price.ms_per_ray = ask_blocks(scene, plan);

  const double rays_a_pass_sample =
      price.rays_per_sample * plan.view.image.width * static_cast<double>(plan.view.image.height);
  const double samples = PassSchedule(plan.view.render).expected_samples({});
  const auto cost_of = [&](double samples_a_pixel) {
    const double rays = rays_a_pass_sample * samples_a_pixel, cpu_ms = rays * price.ms_per_ray;
    return CostPrediction{1e-6 * rays, cpu_ms, cpu_ms / std::max(1, threads)};
  };
  const CostPrediction whole = cost_of(samples), first = cost_of(1.0);
  const auto& time_ms = plan.view.render.time_ms;
  if (!time_ms || whole.elapsed_ms <= *time_ms) return whole;
  return cost_of(std::max(1.0, *time_ms / first.elapsed_ms));  // the first pass is always finished
}

}  // namespace tilelight
