// SPDX-License-Identifier: Apache-2.0
#include "renderer/render/probe.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "renderer/base/hash.h"
#include "renderer/film/error_map.h"
#include "renderer/trace/tile_job.h"

namespace tilelight {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// The rays that it took.
int64_t trace(const CompiledScene& scene, const ViewPlan& plan, const EyeMedia& eye_media, const TileRect& rect,
              TileView* film = nullptr, uint32_t samples = 1) {
  TileCounts counts;
  std::vector<CellWork> cells;
  for_each_cell(rect, [&](const TileRect& cell) { cells.push_back({cell, 0, samples}); });
  kernel_of(plan.variant)(
      {.scene = &scene, .plan = &plan, .eye_media = &eye_media, .film = film, .cells = cells, .counts = &counts});
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

// One sample a cell, all over the image, until all are traced or the time is over.
void ask_pixels(const CompiledScene& scene, const ViewPlan& plan, Probe& probe) {
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
  probe.rays_per_sample = static_cast<double>(rays) / asked;
  probe.ms_per_ray = ms_since(start) / static_cast<double>(rays);
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

// Whole cells, each at a random place of its own part of the image, side by side on a film of their own: the view is
// shifted so that the film's cell sees what the image's would.
void ask_errors(const CompiledScene& scene, const ViewPlan& plan, Probe& probe) {
  constexpr double kEnoughMs = 20.0, kCellMs = 4.0;
  constexpr int kAtLeast = 4, kMostCells = 256;
  const ImageSpec& image = plan.view.image;
  const int cell_width = std::min(kCellPx, image.width), cell_height = std::min(kCellPx, image.height);
  const double samples_a_cell = static_cast<double>(kProbeSamples) * cell_width * cell_height;
  if (samples_a_cell * probe.rays_per_sample * probe.ms_per_ray > kCellMs) return;

  const int places_x = image.width / cell_width, places_y = image.height / cell_height;
  const double aspect = static_cast<double>(places_x) / places_y;
  const int columns =
      std::clamp(static_cast<int>(std::lround(std::sqrt(kMostCells * aspect))), 1, std::min(places_x, kMostCells));
  const int rows = std::clamp(kMostCells / columns, 1, places_y);
  const int count = columns * rows, stride = golden_stride(count);

  ViewPlan shifted = plan;
  const EyeMedia eye_media(scene, plan);
  Film film(count * cell_width, cell_height);
  film.grow(kProbeSamples);
  TileView view = film.view();
  std::vector<int64_t> rays;
  const auto start = Clock::now();
  for (int i = 0, part = 0; i < count && (i < kAtLeast || ms_since(start) < kEnoughMs);
       ++i, part = (part + stride) % count) {
    const uint64_t random = mix64(static_cast<uint64_t>(part));
    // Of `places` along an axis, one in this part of `parts`.
    const auto place = [](int index, int parts, int places, uint64_t bits) {
      const int64_t first = int64_t{index} * places / parts, end = int64_t{index + 1} * places / parts;
      return static_cast<int>(first + static_cast<int64_t>(bits % static_cast<uint64_t>(end - first)));
    };
    const int x = cell_width * place(part % columns, columns, places_x, random & 0xffff);
    const int y = cell_height * place(part / columns, rows, places_y, random >> 32 & 0xffff);
    shifted.eye.corner = plan.eye.corner + static_cast<double>(x - i * cell_width) * plan.eye.step_x +
                         static_cast<double>(y) * plan.eye.step_y;
    rays.push_back(
        trace(scene, shifted, eye_media, {i * cell_width, 0, (i + 1) * cell_width, cell_height}, &view, kProbeSamples));
  }
  const int asked = static_cast<int>(rays.size());
  const double mean_rays = std::accumulate(rays.begin(), rays.end(), 0.0) / asked;
  for (const int64_t r : rays) probe.costs.push_back(static_cast<double>(r) / mean_rays);
  probe.image_part = std::min(1.0, static_cast<double>(asked) / (static_cast<double>(places_x) * places_y));

  std::fill(film.samples().begin(), film.samples().end(), kProbeSamples);  // those not asked differ in nothing
  ErrorMap map(film.width(), film.height(), image.exposure);
  Image means{film.width(), film.height(), std::vector<float>(static_cast<size_t>(film.width()) * film.height() * 3)};
  const TileRect seen{0, 0, asked * cell_width, cell_height};
  film.resolve(seen, means);
  map.measure(film, means, seen);
  map.pool(film);
  probe.decay = map.decay();
  probe.variances = map.own_cell_variances();
  probe.variances.resize(static_cast<size_t>(asked));
  for (double& variance : probe.variances) variance /= cell_width * cell_height;
}

}  // namespace

Probe probe_view(const CompiledScene& scene, const ViewPlan& plan) {
  constexpr double kManyRays = 50.0;  // a sample's; then they are scattered and many enough to tell their own price
  Probe probe;
  ask_pixels(scene, plan, probe);
  if (probe.rays_per_sample < kManyRays) probe.ms_per_ray = ask_blocks(scene, plan);
  ask_errors(scene, plan, probe);
  return probe;
}

}  // namespace tilelight
