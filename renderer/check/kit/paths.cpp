// SPDX-License-Identifier: Apache-2.0
#include "renderer/check/kit/paths.h"

#include "renderer/check/kit/pictures.h"
#include "renderer/trace/tile_job.h"

namespace tilelight::check {
namespace {

class Log : public RayListener {
 public:
  explicit Log(const CompiledScene& scene) : scene_(scene) {}
  void on_ray(const Event& event) override {
    const std::string_view kind = event.kind;
    PathRay ray{event.depth, kind == "primary" ? 'p' : kind == "reflected" ? 'm' : 't'};
    ray.origin = event.ray.origin * scene_.units + scene_.center;
    ray.direction = event.ray.direction;
    ray.weight = event.weight;
    if (event.surface) {
      ray.id = surface_id(scene_.bodies[event.hit.body].body, event.hit.prim);
      ray.hit_point = event.surface->position * scene_.units + scene_.center;
    }
    rays.push_back(ray);
    color += event.weight * event.local;
  }
  void on_light(const CompiledLight&, const LightSample&, const Color&) override {}

  std::vector<PathRay> rays;
  Color color{0.0};

 private:
  const CompiledScene& scene_;
};

}  // namespace

PathScene::PathScene(std::string_view json, TilePool& pool) : PathScene(scene_of(json), pool) {}
PathScene::PathScene(const ParsedScene& parsed, TilePool& pool)
    : scene_(compile_scene(parsed.scene, pool)), plan_(plan_view(*scene_, parsed.view)), eye_media_(*scene_, plan_) {}

Path PathScene::path(int x, int y) const {
  Log log(*scene_);
  const TileCounts counts = explain(*scene_, plan_, eye_media_, {x, y, x + 1, y + 1}, 0, log);
  return {std::move(log.rays), log.color, counts.untraced_weight, counts.reflected + counts.refracted};
}

}  // namespace tilelight::check
