// SPDX-License-Identifier: Apache-2.0
#include "renderer/trace/primary_ids.h"

#include "renderer/base/standard_floats.h"
#include "renderer/trace/tile_job.h"

namespace tilelight {
namespace {

class PrimaryListener : public RayListener {
 public:
  explicit PrimaryListener(const CompiledScene& scene) : scene_(scene) {}
  void on_ray(const Event& event) override {
    if (event.depth > 0 || std::string_view(event.kind) != "primary") return;
    ids.push_back(event.hit.is_hit() ? uint64_t{scene_.bodies[event.hit.body].body} << 32 | event.hit.prim
                                     : ~uint64_t{0});
  }
  void on_light(const CompiledLight&, const LightSample&, const Color&) override {}

  std::vector<uint64_t> ids;

 private:
  const CompiledScene& scene_;
};

}  // namespace

std::vector<uint64_t> primary_ids(const CompiledScene& scene, const ViewPlan& plan) {
  const StandardFloats floats;
  ViewPlan first_hits = plan;
  first_hits.view.render.max_depth = 0;
  first_hits.view.render.shadows = false;
  PrimaryListener listener(scene);
  explain(scene, first_hits, EyeMedia(scene, plan), {0, 0, plan.view.image.width, plan.view.image.height}, 0, listener);
  return std::move(listener.ids);
}

}  // namespace tilelight
