// SPDX-License-Identifier: Apache-2.0
#include "renderer/render/probe.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numeric>

#include "renderer/base/hash.h"
#include "renderer/film/error_map.h"
#include "renderer/trace/tile_job.h"

namespace tilelight {
namespace {

// Of this thread alone: what others do on the machine is not the render's price, and does not cut the probe short.
double cpu_ms() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

// A block or a spot that would take more than so much of its part of the budget is not tried: a handful tells nothing.
constexpr double kDearestBlock = 0.3, kDearestSpot = 0.15;

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
void ask_pixels(const CompiledScene& scene, const ViewPlan& plan, double enough_ms, Probe& probe) {
  constexpr int kAtLeast = 8;
  const ViewPlan cells = in_cells(plan);
  const EyeMedia eye_media(scene, cells);
  const int width = cells.view.image.width, count = width * cells.view.image.height, stride = golden_stride(count);
  const double start = cpu_ms();
  int64_t rays = 0, place = 0;
  int asked = 0;
  for (; asked < count && (asked < kAtLeast || cpu_ms() - start < enough_ms);
       ++asked, place = (place + stride) % count) {
    const int x = static_cast<int>(place % width), y = static_cast<int>(place / width);
    rays += trace(scene, cells, eye_media, {x, y, x + 1, y + 1});
  }
  probe.rays_per_sample = static_cast<double>(rays) / asked;
  probe.ms_per_ray = (cpu_ms() - start) / static_cast<double>(rays);
}

// What a ray costs among its neighbours: blocks all over the image, each of as many samples as a kernel takes at a
// time. A pixel alone pays too much for setting out.
void ask_blocks(const CompiledScene& scene, const ViewPlan& plan, double enough_ms, Probe& probe) {
  constexpr int kBlockPx = 2 * kCellPx, kBlocks = 32;
  constexpr uint32_t kSamples = 4;
  if (kBlockPx * kBlockPx * kSamples * probe.rays_per_sample * probe.ms_per_ray > kDearestBlock * enough_ms) return;
  const ImageSpec& image = plan.view.image;
  const int count = tile_count(image.width, image.height, kBlockPx), stride = golden_stride(count);
  const EyeMedia eye_media(scene, plan);
  const double start = cpu_ms();
  int64_t rays = 0, block = 0;
  for (int i = 0; i < std::min(count, kBlocks) && cpu_ms() - start < enough_ms; ++i, block = (block + stride) % count)
    rays += trace(scene, plan, eye_media, tile_rect(static_cast<int>(block), image.width, image.height, kBlockPx),
                  nullptr, kSamples);
  probe.ms_per_ray = (cpu_ms() - start) / static_cast<double>(rays);
}

// Of `places` along an axis, one at random in this part of `parts`.
int place_in(int part, int parts, int places, uint64_t bits) {
  const int64_t first = int64_t{part} * places / parts, end = int64_t{part + 1} * places / parts;
  return static_cast<int>(first + static_cast<int64_t>(bits % static_cast<uint64_t>(end - first)));
}

// Single pixels, each at a random place of its own part of the image. On a film of their own they stand side by side, a
// cell for each: the view is shifted so that a pixel sees what it would see in the image.
void ask_spots(const CompiledScene& scene, const ViewPlan& plan, double enough_ms, Probe& probe) {
  constexpr int kAtLeast = 8, kMostSpots = 768;
  const ImageSpec& image = plan.view.image;
  if (kProbeSamples * probe.rays_per_sample * probe.ms_per_ray > kDearestSpot * enough_ms) return;

  const double aspect = static_cast<double>(image.width) / image.height;
  const int columns =
      std::clamp(static_cast<int>(std::lround(std::sqrt(kMostSpots * aspect))), 1, std::min(image.width, kMostSpots));
  const int rows = std::clamp(kMostSpots / columns, 1, image.height);
  const int count = columns * rows, stride = golden_stride(count);

  ViewPlan shifted = plan;
  const EyeMedia eye_media(scene, plan);
  // What the image plane of an orthographic eye cuts is known by the place in the image, which moves.
  const bool has_own_media = plan.eye.projection == Projection::orthographic && scene.media > 0;
  Film film(count * kCellPx, kCellPx);
  film.fill_black(kProbeSamples);  // what no spot covers stays so, and differs in nothing
  TileView view = film.view();
  std::vector<int64_t> rays;
  const double start = cpu_ms();
  for (int i = 0, part = 0; i < count && (i < kAtLeast || cpu_ms() - start < enough_ms);
       ++i, part = (part + stride) % count) {
    const uint64_t random = mix64(static_cast<uint64_t>(part));
    const int x = place_in(part % columns, columns, image.width, random & 0xffff);
    const int y = place_in(part / columns, rows, image.height, random >> 32 & 0xffff);
    const int there = i * kCellPx;
    shifted.eye.corner =
        plan.eye.corner + static_cast<double>(x - there) * plan.eye.step_x + static_cast<double>(y) * plan.eye.step_y;
    const TileRect spot{there, 0, there + 1, 1};
    rays.push_back(has_own_media ? trace(scene, shifted, EyeMedia(scene, shifted), spot, &view, kProbeSamples)
                                 : trace(scene, shifted, eye_media, spot, &view, kProbeSamples));
  }
  const int asked = static_cast<int>(rays.size());
  const double all_rays = std::accumulate(rays.begin(), rays.end(), 0.0);
  probe.ms_per_ray = (cpu_ms() - start) / all_rays;
  if (asked == count) probe.rays_per_sample = all_rays / (static_cast<double>(asked) * kProbeSamples);
  for (const int64_t r : rays) probe.costs.push_back(static_cast<double>(r) * asked / all_rays);
  probe.image_part = static_cast<double>(asked) / (static_cast<double>(image.width) * image.height);

  ErrorMap map(film.width(), film.height(), image.exposure);
  Image means{film.width(), film.height(), std::vector<float>(static_cast<size_t>(film.width()) * film.height() * 3)};
  const TileRect all{0, 0, film.width(), film.height()};
  film.resolve(all, means);
  map.measure(film, means, all);
  map.pool(film);
  probe.decay = map.decay();
  probe.variances = map.own_cell_variances();
  probe.variances.resize(static_cast<size_t>(asked));
}

}  // namespace

Probe probe_view(const CompiledScene& scene, const ViewPlan& plan, double budget_ms) {
  Probe probe;
  ask_pixels(scene, plan, 0.25 * budget_ms, probe);
  ask_spots(scene, plan, 0.5 * budget_ms, probe);
  ask_blocks(scene, plan, 0.25 * budget_ms, probe);
  return probe;
}

}  // namespace tilelight
