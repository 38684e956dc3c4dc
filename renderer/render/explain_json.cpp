// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <nlohmann/json.hpp>

#include "renderer/base/characters.h"
#include "renderer/base/standard_floats.h"
#include "renderer/compile/tessellate.h"
#include "renderer/film/tone.h"
#include "renderer/render/explain.h"
#include "renderer/trace/tile_job.h"

namespace tilelight {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Vec3& v) { return {v.x, v.y, v.z}; }

// Gathers the rays of one sample; places are told in the user's units.
class Explainer : public RayListener {
 public:
  explicit Explainer(const CompiledScene& scene) : scene_(scene) {}

  void on_ray(const Event& event) override {
    color += event.weight * event.local;
    weight_ = event.weight;
    is_truncated = rays.size() >= kMostRays;
    if (is_truncated) return;
    rays.push_back({{"depth", event.depth},
                    {"kind", event.kind},
                    {"weight", json_of(event.weight)},
                    {"origin", json_of(user_point(event.ray.origin))},
                    {"direction", json_of(event.ray.direction)}});
    Json& ray = rays.back();
    if (event.surface == nullptr) {
      ray["hit"] = nullptr;
      ray["background"] = json_of(event.local);
      return;
    }
    const Surface& s = *event.surface;
    ray["hit"] = {{"object", s.body->name},
                  {"body", s.body->body},
                  {"primitive", event.hit.prim},
                  {"t", event.hit.t * scene_.units},
                  {"position", json_of(user_point(s.position))},
                  {"normal", json_of(s.normal)},
                  {"geometric_normal", json_of(s.geometric_normal)},
                  {"side", s.from_outside ? "outside" : "inside"},
                  {"material", s.material->source.name}};
    ray["ambient"] = json_of(event.local);
    ray["lights"] = Json::array();
  }

  void on_light(const CompiledLight& light, const LightSample& sample, const Color& visible) override {
    color += weight_ * visible * (sample.diffuse + sample.specular);
    if (is_truncated) return;
    Json& lights = rays.back()["lights"];
    lights.push_back({{"light", "lights/" + std::to_string(light.light)}, {"faces_light", sample.is_lit}});
    if (!sample.is_lit) return;
    Json& out = lights.back();
    out["distance"] = std::isfinite(sample.distance) ? Json(sample.distance * scene_.units) : Json(nullptr);
    out["arriving"] = json_of(sample.arriving);
    out["diffuse"] = json_of(sample.diffuse);
    out["specular"] = json_of(sample.specular);
    out["visible"] = json_of(visible);
  }

  static constexpr size_t kMostRays = 1000;
  Json rays = Json::array();  // the first kMostRays
  bool is_truncated = false;
  Color color{0.0};  // of all rays

 private:
  Vec3 user_point(const Vec3& p) const { return p * scene_.units + scene_.center; }

  const CompiledScene& scene_;
  Color weight_{1.0};
};

}  // namespace

Result<std::string> explain_pixel_json(const std::shared_ptr<const CompiledScene>& scene, const ViewPlan& plan,
                                       TilePool& pool, int x, int y, int sample) {
  const StandardFloats floats;
  const ImageSpec& image = plan.view.image;
  if (sample < 0) return fail("out_of_range", "found sample " + std::to_string(sample) + "; allowed: 0 and more");
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) {
    return fail("out_of_range", "pixel " + std::to_string(x) + "," + std::to_string(y) + " lies outside the image of " +
                                    std::to_string(image.width) + "x" + std::to_string(image.height) +
                                    "; allowed: 0.." + std::to_string(image.width - 1) + ", 0.." +
                                    std::to_string(image.height - 1));
  }
  const auto drawn = drawn_scene(scene, plan, pool);
  Explainer explainer(*drawn);
  const TileCounts counts =
      explain(*drawn, plan, EyeMedia(*drawn, plan), {x, y, x + 1, y + 1}, static_cast<uint32_t>(sample), explainer);

  Json srgb = Json::array();
  for (int c = 0; c < 3; ++c) {
    srgb.push_back(static_cast<int>(displayed(explainer.color[c], image.exposure) * 255.0 + 0.5));
  }
  const Json out = {{"pixel", {x, y}},
                    {"sample", sample},
                    {"color_linear", json_of(explainer.color)},
                    {"color_srgb8", srgb},
                    {"untraced_weight", counts.untraced_weight},
                    {"rays_truncated", explainer.is_truncated},
                    {"rays", explainer.rays}};
  return printable_json(out.dump());
}

}  // namespace tilelight
