// SPDX-License-Identifier: Apache-2.0
// A document that the parser accepts compiles, is planned and renders: nothing crashes, what is compiled is finite, and
// so is every sample.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "renderer/compile/compiled_scene.h"
#include "renderer/render/explain.h"
#include "renderer/render/render.h"
#include "renderer/scene/parse.h"
#include "tests/fuzz/require.h"

namespace tilelight::fuzz {
namespace {

bool is_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

template <class Matrix>
bool is_finite_matrix(const Matrix& m) {
  for (int column = 0; column < Matrix::length(); ++column)
    for (int row = 0; row < Matrix::length(); ++row)
      if (!std::isfinite(m[column][row])) return false;
  return true;
}

Limits small_limits() {
  Limits limits;
  limits.json_values = 2000;
  limits.objects = 16;
  limits.lights = 6;
  limits.mesh_triangles = 200;
  limits.instanced_triangles = 40'000;
  return limits;
}

void check_compiled(const CompiledScene& scene, std::string_view text) {
  const std::string told(text);
  REQUIRE(scene.units > 0.0 && std::isfinite(scene.units) && is_finite(scene.center), told);
  REQUIRE(scene.bounding_radius > 0.0 && std::isfinite(scene.bounding_radius), told);
  REQUIRE(scene.finite_bodies <= scene.bodies.size() && !scene.bodies.empty(), told);
  REQUIRE(scene.tree.depth <= 64, told);
  for (const CompiledBody& body : scene.bodies) {
    REQUIRE(is_finite_matrix(body.world_from_local) && is_finite_matrix(body.local_from_world), told);
    REQUIRE(is_finite_matrix(body.world_from_normal), told);
    REQUIRE(body.material < scene.materials.size(), told);
  }
  for (const CompiledLight& light : scene.lights)
    REQUIRE(is_finite(light.position) && is_finite(light.to_light) && is_finite(light.intensity), told);
  for (const SceneWarning& warning : scene.plan.warnings)
    REQUIRE(!warning.code.empty() && !warning.detail.empty(), told);
}

std::vector<float> draw(const std::shared_ptr<const CompiledScene>& scene, const View& view, TilePool& pool,
                        const std::string& told) {
  const auto render = Render::start(pool, Priority::normal, scene, plan_view(*scene, view));
  while (!render->wait_ms(1e9)) continue;
  REQUIRE(render->progress().state == RenderState::done, told + render->progress().error);
  REQUIRE(render->report().points.back().nonfinite == 0, told);
  for (const float value : render->image()->rgb) REQUIRE(std::isfinite(value) && value >= 0.0f, told);
  return render->image()->rgb;
}

// The methods on triangles bear any scene too, and two of them show the same.
void check_methods(const std::shared_ptr<const CompiledScene>& scene, View view, TilePool& pool,
                   const std::string& told) {
  view.render.chord_error_px = std::max(view.render.chord_error_px, 0.25);
  view.render.algorithm = Algorithm::zbuffer;
  const std::vector<float> zbuffer = draw(scene, view, pool, told);
  view.render.algorithm = Algorithm::warnock;
  REQUIRE(draw(scene, view, pool, told) == zbuffer, told);
  view.render.algorithm = Algorithm::roberts;
  draw(scene, view, pool, told);
}

void check_view(std::shared_ptr<const CompiledScene> scene, View view, TilePool& pool, std::string_view text) {
  const std::string told(text);
  view.image.width = 6, view.image.height = 4;
  view.render.max_depth = std::min(view.render.max_depth, 5);
  view.render.ray_budget = std::min(view.render.ray_budget, 64);
  view.render.samples = 1;
  view.render.time_ms.reset();
  view.render.passes.clear();
  const ViewPlan plan = plan_view(*scene, view);
  REQUIRE(is_finite(plan.eye.origin) && is_finite(plan.eye.forward) && is_finite(plan.eye.corner), told);
  REQUIRE(is_finite(plan.eye.step_x) && is_finite(plan.eye.step_y), told);
  REQUIRE(is_finite(plan.camera.position) && is_finite(plan.camera.target), told);
  REQUIRE(!plan_json(plan.plan).empty(), told);

  draw(scene, view, pool, told);
  check_methods(scene, view, pool, told);
  REQUIRE(explain_pixel_json(scene, plan, pool, 3, 2, 0), told);
}

}  // namespace
}  // namespace tilelight::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace tilelight;
  static TilePool pool(1);
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto parsed = parse_scene(text, fuzz::small_limits());
  if (!parsed) return -1;  // not kept: `scene` has those
  const auto compiled = compile_scene(parsed->scene, pool);
  fuzz::check_compiled(*compiled, text);
  fuzz::check_view(compiled, parsed->view, pool, text);
  return 0;
}
