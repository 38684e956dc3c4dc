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

// One tile of a frame, level by level; keep(depth, any_hit, rays) is shown every batch before it is traced.
template <class Keep>
double render_tile(const CompiledScene& scene, const ViewPlan& plan, const FrameSpec& spec, const TileRect& rect,
                   const Keep& keep) {
  struct Path {
    Color weight{1.0};
  };
  Batch rays;
  std::vector<Path> paths;
  for_each_cell(rect, [&](const TileRect& cell) {
    for_each_pixel(cell, [&](int x, int y) {
      const SamplePoint p = sample_point(x, y, 0, 0);
      const EyeRay ray = eye_ray(plan.eye, x + p.x, y + p.y);
      rays.push_back({{ray.origin, ray.direction, {}}});
    });
  });
  paths.resize(rays.size());

  Color sum(0.0);
  std::vector<Hit> hits;
  std::vector<uint8_t> is_blocked;
  for (int depth = 0; depth <= spec.max_depth && !rays.empty(); ++depth) {
    keep(depth, false, rays);
    hits.resize(rays.size());
    trace_closest(scene, rays, hits);
    Batch next;
    std::vector<Path> next_paths;
    std::vector<Batch> beams(scene.lights.size());
    std::vector<std::vector<Color>> arriving(scene.lights.size());
    for (size_t i = 0; i < rays.size(); ++i) {
      if (!hits[i].is_hit()) {
        sum += paths[i].weight * background_color(scene.background, rays[i].ray.direction);
        continue;
      }
      const Surface surface = make_surface(scene, rays[i].ray, hits[i]);
      sum += paths[i].weight * scene.ambient * surface.ambient;
      for (size_t l = 0; l < scene.lights.size(); ++l) {
        const LightSample sample = sample_light(scene, scene.lights[l], surface, -rays[i].ray.direction, false);
        if (!sample.is_lit) continue;
        const Color light = paths[i].weight * (sample.diffuse + sample.specular);
        if (static_cast<int>(l) >= spec.shadow_lights) {
          sum += light;
          continue;
        }
        beams[l].push_back(
            {{surface.position, sample.to_light, surface.here, Coincident::before}, sample.distance * (1.0 - 0x1p-40)});
        arriving[l].push_back(light);
      }
      if (depth == spec.max_depth || !surface.material->is_reflective) continue;
      const Scatter out = scatter_opaque(surface, rays[i].ray.direction);
      next.push_back({{surface.position, out.mirrored, surface.here, Coincident::before}});
      next_paths.push_back({paths[i].weight * out.mirror_weight});
    }
    for (size_t l = 0; l < beams.size(); ++l) {
      if (beams[l].empty()) continue;
      keep(depth, true, beams[l]);
      is_blocked.resize(beams[l].size());
      trace_any(scene, beams[l], is_blocked);
      for (size_t i = 0; i < beams[l].size(); ++i)
        if (!is_blocked[i]) sum += arriving[l][i];
    }
    rays = std::move(next);
    paths = std::move(next_paths);
  }
  return sum.r + sum.g + sum.b;
}

template <class Keep>
double render_tiles(const CompiledScene& scene, const ViewPlan& plan, const FrameSpec& spec, TilePool& pool,
                    const Keep& keep) {
  const ImageSpec& image = plan.view.image;
  const int count = tile_count(image.width, image.height, kTilePx);
  std::vector<double> sums(static_cast<size_t>(count));
  pool.parallel_for(count, Priority::normal, [&](int64_t tile) {
    const TileRect rect = tile_rect(static_cast<int>(tile), image.width, image.height, kTilePx);
    sums[static_cast<size_t>(tile)] = render_tile(
        scene, plan, spec, rect,
        [&](int depth, bool any_hit, const Batch& b) { keep(static_cast<size_t>(tile), depth, any_hit, b); });
  });
  double sum = 0.0;
  for (const double s : sums) sum += s;
  return sum;
}

}  // namespace

int64_t Wave::rays() const {
  int64_t sum = 0;
  for (const Batch& b : batches) sum += static_cast<int64_t>(b.size());
  return sum;
}

std::vector<Wave> waves_of(const CompiledScene& scene, const ViewPlan& plan, const FrameSpec& spec, TilePool& pool) {
  const ImageSpec& image = plan.view.image;
  std::vector<std::vector<Wave>> tiles(static_cast<size_t>(tile_count(image.width, image.height, kTilePx)));
  render_tiles(scene, plan, spec, pool, [&](size_t tile, int depth, bool any_hit, const Batch& batch) {
    tiles[tile].push_back({depth, any_hit, {batch}});
  });
  std::vector<Wave> waves;
  for (int depth = 0; depth <= spec.max_depth; ++depth)
    for (const bool any_hit : {false, true}) waves.push_back({depth, any_hit, {}});
  for (auto& tile : tiles)
    for (Wave& wave : tile)
      waves[static_cast<size_t>(2 * wave.depth + (wave.any_hit ? 1 : 0))].batches.push_back(std::move(wave.batches[0]));
  std::erase_if(waves, [](const Wave& wave) { return wave.batches.empty(); });
  return waves;
}

double shade_frame(const CompiledScene& scene, const ViewPlan& plan, const FrameSpec& spec, TilePool& pool) {
  return render_tiles(scene, plan, spec, pool, [](size_t, int, bool, const Batch&) {});
}

void trace_waves(const CompiledScene& scene, const std::vector<Wave>& waves, TilePool& pool) {
  for (const Wave& wave : waves) {
    pool.parallel_for(static_cast<int64_t>(wave.batches.size()), Priority::normal, [&](int64_t i) {
      const Batch& rays = wave.batches[static_cast<size_t>(i)];
      if (wave.any_hit) {
        std::vector<uint8_t> is_blocked(rays.size());
        trace_any(scene, rays, is_blocked);
      } else {
        std::vector<Hit> hits(rays.size());
        trace_closest(scene, rays, hits);
      }
    });
  }
}

}  // namespace tilelight::bench
