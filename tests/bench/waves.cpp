// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/waves.h"

#include <algorithm>

#include "renderer/film/sampling.h"
#include "renderer/shade/light_equation.h"
#include "renderer/shade/scatter.h"
#include "renderer/shade/surface.h"
#include "tests/bench/timing.h"

namespace tilelight::bench {
namespace {

constexpr int kTilePx = 32;

// What follows from these primary rays, level by level.
PixelWaves follow(const CompiledScene& scene, const ViewPlan& plan, std::vector<BoundedRay> rays) {
  PixelWaves waves;
  std::vector<Hit> hits;
  for (int depth = 0; depth <= plan.view.render.max_depth && !rays.empty(); ++depth) {
    hits.resize(rays.size());
    trace_closest(scene, rays, hits);
    std::vector<BoundedRay> next;
    std::vector<std::vector<BoundedRay>> beams(scene.lights.size());
    for (size_t i = 0; i < rays.size(); ++i) {
      if (!hits[i].is_hit()) continue;
      const Surface surface = make_surface(scene, rays[i].ray, hits[i]);
      for (size_t l = 0; l < scene.lights.size(); ++l) {
        if (!scene.lights[l].shadow) continue;
        const LightSample sample = sample_light(scene, scene.lights[l], surface, -rays[i].ray.direction, false);
        if (!sample.is_lit) continue;
        beams[l].push_back(
            {{surface.position, sample.to_light, surface.here, Coincident::before}, sample.distance * (1.0 - 0x1p-40)});
      }
      if (depth == plan.view.render.max_depth || !surface.material->is_reflective) continue;
      const Vec3 mirrored = mirror_direction(surface, rays[i].ray.direction);
      next.push_back({{surface.position, mirrored, surface.here, Coincident::before}});
    }
    waves.push_back({depth, false, std::move(rays)});
    for (auto& beam : beams) {
      if (!beam.empty()) waves.push_back({depth, true, std::move(beam)});
    }
    rays = std::move(next);
  }
  return waves;
}

}  // namespace

std::vector<std::vector<BoundedRay>> primary_rays(const ViewPlan& plan) {
  constexpr int64_t kBatchPixels = 256;  // as a kernel's
  const ImageSpec& image = plan.view.image;
  std::vector<std::vector<BoundedRay>> batches;
  for (int tile = 0; tile < tile_count(image.width, image.height, kTilePx); ++tile) {
    int64_t pixels = kBatchPixels;
    for_each_cell(tile_rect(tile, image.width, image.height, kTilePx), [&](const TileRect& cell) {
      if (pixels + cell.pixel_count() > kBatchPixels) batches.emplace_back(), pixels = 0;
      pixels += cell.pixel_count();
      for_each_pixel(cell, [&](int x, int y) {
        const SamplePoint p = sample_point(x, y, 0, 0);
        const EyeRay ray = eye_ray(plan.eye, x + p.x, y + p.y);
        batches.back().push_back({{ray.origin, ray.direction, {}}});
      });
    });
  }
  return batches;
}

FrameWaves waves_of(const CompiledScene& scene, const ViewPlan& plan, TilePool& pool) {
  std::vector<std::vector<BoundedRay>> primary = primary_rays(plan);
  FrameWaves frame(primary.size());
  pool.parallel_for(static_cast<int64_t>(frame.size()), Priority::normal, [&](int64_t i) {
    frame[static_cast<size_t>(i)] = follow(scene, plan, std::move(primary[static_cast<size_t>(i)]));
  });
  return frame;
}

std::string WaveKind::name() const { return "depth " + std::to_string(depth) + (any_hit ? " shadow" : " closest"); }

std::vector<WaveKind> kinds_of(const FrameWaves& frame) {
  std::vector<WaveKind> kinds;
  for (const PixelWaves& waves : frame) {
    for (const Wave& wave : waves) {
      const auto at = static_cast<size_t>(2 * wave.depth + (wave.any_hit ? 1 : 0));
      while (kinds.size() <= at) kinds.push_back({static_cast<int>(kinds.size()) / 2, kinds.size() % 2 == 1, 0});
      kinds[at].rays += static_cast<int64_t>(wave.rays.size());
    }
  }
  std::erase_if(kinds, [](const WaveKind& kind) { return kind.rays == 0; });
  return kinds;
}

FrameWaves only(const FrameWaves& frame, const WaveKind& kind, size_t every) {
  FrameWaves out;
  size_t seen = 0;
  for (const PixelWaves& waves : frame) {
    PixelWaves of_kind;
    for (const Wave& wave : waves)
      if (wave.depth == kind.depth && wave.any_hit == kind.any_hit) of_kind.push_back(wave);
    if (!of_kind.empty() && seen++ % every == 0) out.push_back(std::move(of_kind));
  }
  return out;
}

double trace_waves(const CompiledScene& scene, const FrameWaves& frame, TilePool& pool) {
  SpentTime spent;
  pool.parallel_for(static_cast<int64_t>(frame.size()), Priority::normal, [&](int64_t i) {
    thread_local std::vector<BoundedRay> rays;
    thread_local std::vector<uint8_t> is_blocked;
    thread_local std::vector<Hit> hits;
    for (const Wave& wave : frame[static_cast<size_t>(i)]) {
      rays = wave.rays;
      if (wave.any_hit) {
        is_blocked.resize(rays.size());
        spent.spend([&] { trace_any(scene, rays, is_blocked); });
      } else {
        hits.resize(rays.size());
        spent.spend([&] { trace_closest(scene, rays, hits); });
      }
    }
  });
  return spent.seconds() / pool.thread_count();
}

}  // namespace tilelight::bench
