// SPDX-License-Identifier: Apache-2.0
#include "renderer/compile/compile.h"

#include <algorithm>
#include <cmath>

#include "renderer/base/elementary.h"
#include "renderer/base/standard_floats.h"
#include "renderer/compile/passes.h"
#include "renderer/compile/stopwatch.h"

namespace tilelight {
namespace {

void rebase_lights(CompiledScene& scene) {
  for (CompiledLight& light : scene.lights) light.position = (light.position - scene.center) / scene.units;
}

}  // namespace

std::shared_ptr<const CompiledScene> compile_scene(const Scene& scene, TilePool& pool) {
  const StandardFloats floats;
  const Stopwatch watch;
  auto out = std::make_shared<CompiledScene>();
  LeftOutList left_out;
  out->background = scene.background;
  out->ambient = scene.ambient;
  out->attenuation = scene.attenuation;

  std::vector<Body> bodies = make_bodies(scene);
  out->materials = drop_unused_materials(scene, bodies, left_out);
  out->lights = drop_dead_lights(scene, out->materials, left_out);
  rebase_and_normalise(bodies, *out);
  rebase_lights(*out);
  for (uint32_t i = 0; i < out->bodies.size(); ++i) out->media += is_medium(*out, i);
  out->passed_on = find_passed_on(*out);
  out->radiance_bound = find_radiance_bound(*out);
  out->plan.features = find_features(*out, left_out);
  build_trees(pool, *out);
  find_touching_media(*out);

  Plan& plan = out->plan;
  plan.left_out.insert(plan.left_out.end(), left_out.begin(), left_out.end());
  plan.warnings = find_odd_glass(bodies);
  plan.stiffness = find_stiffness(*out);
  plan.lights = static_cast<int64_t>(out->lights.size());
  plan.memory_bytes += static_cast<int64_t>(sizeof(CompiledScene) + out->bodies.size() * sizeof(CompiledBody));
  plan.compile_ms = watch.ms();
  return out;
}

const Plan& scene_plan(const CompiledScene& scene) { return scene.plan; }

Camera framed_camera(const CompiledScene& scene, int width, int height) {
  const StandardFloats floats;
  using namespace elementary;
  constexpr double kMargin = 1.05;
  const double azimuth = rad_from_deg(30.0), elevation = rad_from_deg(25.0);
  Camera camera;
  const double half_y = rad_from_deg(0.5 * camera.fov_y_deg);
  const double half_x = atan2(tan(half_y) * width / height, 1.0);
  const Vec3 place = glm::abs(scene.bounding_center);
  // Bodies too small for where they stand: an eye that near would be rounded onto them.
  const double least = 0x1p-40 * std::max({place.x, place.y, place.z});
  const double radius = std::max(scene.bounding_radius > 0.0 ? scene.bounding_radius : 1.0, least);
  const double distance = kMargin * radius / sin(std::min(half_x, half_y));
  camera.target = scene.bounding_center;
  camera.position =
      camera.target + distance * Vec3(sin(azimuth) * cos(elevation), sin(elevation), cos(azimuth) * cos(elevation));
  return camera;
}

}  // namespace tilelight
