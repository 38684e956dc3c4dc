// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/waves.h"

#include <algorithm>
#include <atomic>

#include "renderer/film/sampling.h"
#include "renderer/shade/light_equation.h"
#include "renderer/shade/scatter.h"
#include "renderer/shade/surface.h"

namespace tilelight::bench {
namespace {

constexpr int kTilePx = 32;

// One tile of a frame, level by level; keep(depth, any_hit, rays) is shown every batch.
template <class Keep>
void follow_tile(const CompiledScene& scene, const ViewPlan& plan, const TileRect& rect, const Keep& keep) {
  Batch rays;
  for_each_cell(rect, [&](const TileRect& cell) {
    for_each_pixel(cell, [&](int x, int y) {
      const SamplePoint p = sample_point(x, y, 0, 0);
      const EyeRay ray = eye_ray(plan.eye, x + p.x, y + p.y);
      rays.push_back({{ray.origin, ray.direction, {}}});
    });
  });
  std::vector<Hit> hits;
  for (int depth = 0; depth <= plan.view.render.max_depth && !rays.empty(); ++depth) {
    keep(depth, false, rays);
    hits.resize(rays.size());
    trace_closest(scene, rays, hits);
    Batch next;
    std::vector<Batch> beams(scene.lights.size());
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
    for (const Batch& beam : beams) {
      if (!beam.empty()) keep(depth, true, beam);
    }
    rays = std::move(next);
  }
}

}  // namespace

int64_t Wave::rays() const {
  int64_t sum = 0;
  for (const Batch& b : batches) sum += static_cast<int64_t>(b.size());
  return sum;
}

std::vector<Wave> waves_of(const CompiledScene& scene, const ViewPlan& plan, TilePool& pool) {
  const ImageSpec& image = plan.view.image;
  std::vector<std::vector<Wave>> tiles(static_cast<size_t>(tile_count(image.width, image.height, kTilePx)));
  pool.parallel_for(static_cast<int64_t>(tiles.size()), Priority::normal, [&](int64_t tile) {
    follow_tile(scene, plan, tile_rect(static_cast<int>(tile), image.width, image.height, kTilePx),
                [&](int depth, bool any_hit, const Batch& batch) {
                  tiles[static_cast<size_t>(tile)].push_back({depth, any_hit, {batch}});
                });
  });
  std::vector<Wave> waves;
  for (int depth = 0; depth <= plan.view.render.max_depth; ++depth)
    for (const bool any_hit : {false, true}) waves.push_back({depth, any_hit, {}});
  for (auto& tile : tiles)
    for (Wave& wave : tile)
      waves[static_cast<size_t>(2 * wave.depth + (wave.any_hit ? 1 : 0))].batches.push_back(std::move(wave.batches[0]));
  std::erase_if(waves, [](const Wave& wave) { return wave.batches.empty(); });
  return waves;
}

void trace_waves(const CompiledScene& scene, const std::vector<Wave>& waves, TilePool& pool) {
  for (const Wave& wave : waves) {
    pool.parallel_for(static_cast<int64_t>(wave.batches.size()), Priority::normal, [&](int64_t i) {
      const Batch& rays = wave.batches[static_cast<size_t>(i)];
      if (wave.any_hit) {  // the answers' places are kept, as a kernel keeps them and as the peer has them in its rays
        thread_local std::vector<uint8_t> is_blocked;
        is_blocked.resize(rays.size());
        trace_any(scene, rays, is_blocked);
      } else {
        thread_local std::vector<Hit> hits;
        hits.resize(rays.size());
        trace_closest(scene, rays, hits);
      }
    });
  }
}

}  // namespace tilelight::bench
