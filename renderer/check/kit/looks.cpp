// SPDX-License-Identifier: Apache-2.0
#include "renderer/check/kit/looks.h"

#include "renderer/check/kit/pictures.h"
#include "renderer/compile/compiled_scene.h"
#include "renderer/trace/tile_job.h"

namespace tilelight::check {
namespace {

class Watcher : public RayListener {
 public:
  explicit Watcher(const CompiledScene& scene) : scene_(scene) {}
  void on_ray(const Event& event) override {
    Seen seen;
    if (event.surface) {
      seen.id = surface_id(scene_.bodies[event.hit.body].body, event.hit.prim);
      seen.at = event.surface->position * scene_.units + scene_.center;
    }
    pixels.push_back(seen);
  }
  void on_light(const CompiledLight&, const LightSample&, const Color& visible) override {
    pixels.back().is_lit |= visible != Color(0.0);
  }
  std::vector<Seen> pixels;

 private:
  const CompiledScene& scene_;
};

}  // namespace

std::vector<Seen> look(std::string_view json, TilePool& pool, std::optional<TileRect> part) {
  ParsedScene parsed = scene_of(json);
  parsed.view.render.max_depth = 0;
  const auto compiled = compile_scene(parsed.scene, pool);
  const ViewPlan plan = plan_view(*compiled, parsed.view);
  const EyeMedia eye_media(*compiled, plan);
  const TileRect rect = part.value_or(TileRect{0, 0, parsed.view.image.width, parsed.view.image.height});
  std::vector<std::vector<Seen>> rows(static_cast<size_t>(rect.height()));
  pool.parallel_for(rect.height(), Priority::normal, [&](int64_t row) {
    Watcher watcher(*compiled);
    const int y = rect.y0 + static_cast<int>(row);
    explain(*compiled, plan, eye_media, {rect.x0, y, rect.x1, y + 1}, 0, watcher);
    rows[static_cast<size_t>(row)] = std::move(watcher.pixels);
  });
  std::vector<Seen> pixels;
  for (const auto& row : rows) pixels.insert(pixels.end(), row.begin(), row.end());
  return pixels;
}

}  // namespace tilelight::check
