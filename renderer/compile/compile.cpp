// SPDX-License-Identifier: Apache-2.0
#include "renderer/compile/compile.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <glm/gtc/matrix_access.hpp>

#include "renderer/base/elementary.h"
#include "renderer/base/standard_floats.h"
#include "renderer/compile/passes.h"
#include "renderer/compile/tessellate.h"
#include "renderer/scene/words.h"

namespace tilelight {
namespace {

class Stopwatch {
 public:
  double ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// One convex body, seen from outside: where a light shines on it nothing of it stands between, and what it mirrors is
// not itself.
bool is_convex_seen_from_outside(const CompiledScene& scene, const ViewPlan& plan) {
  if (scene.bodies.size() != 1 || scene.materials[scene.bodies[0].material].is_transmissive) return false;
  const CompiledBody& body = scene.bodies[0];
  if (body.kind == BodyKind::plane) return true;
  if (plan.eye.projection == Projection::orthographic) return false;  // its rays start in many places
  const Vec3 eye = glm::abs(transform_point(body.local_from_world, plan.eye.origin));
  constexpr double kClearly = 1.0 + 0x1p-20;
  if (body.kind == BodyKind::sphere) return glm::dot(eye, eye) > kClearly;
  const Vec3 half = kClearly * body.half;
  return body.kind == BodyKind::box && (eye.x > half.x || eye.y > half.y || eye.z > half.z);
}

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

  Plan& plan = out->plan;
  plan.left_out.insert(plan.left_out.end(), left_out.begin(), left_out.end());
  plan.warnings = find_open_glass(bodies, *out);
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

ViewPlan plan_view(const CompiledScene& scene, const View& view, std::string_view isa) {
  const StandardFloats floats;
  const Stopwatch watch;
  ViewPlan out;
  out.view = view;
  out.plan = scene.plan;
  out.features = scene.plan.features;
  out.camera = view.camera ? *view.camera : framed_camera(scene, view.image.width, view.image.height);
  out.view.camera = out.camera;
  out.eye = make_eye(out.camera, view.image.width, view.image.height, scene.center, scene.units);
  std::vector<Vec4> planes;
  for (size_t i = scene.finite_bodies; i < scene.bodies.size(); ++i)
    planes.push_back(glm::row(scene.bodies[i].local_from_world, 1));  // y = 0 in its own space
  start_near_bodies(out.eye, (out.camera.target - scene.center) / scene.units, view.image.width, view.image.height,
                    planes);
  const auto leave_out = [&](Feature feature, const std::string& why) {
    if (!out.features.has(feature)) return;
    out.features.remove(feature);
    out.plan.left_out.push_back({"feature " + std::string(feature_name(feature)), why});
  };
  if (!view.render.shadows) {
    leave_out(Feature::shadows, "the view asks for none");
    leave_out(Feature::tinted_shadows, "the view asks for no shadows");
  }
  if (is_convex_seen_from_outside(scene, out))
    leave_out(Feature::shadows, "a single convex body, seen from outside, hides nothing of itself from a light");
  const bool follows_rays = view.render.algorithm == Algorithm::raytrace;
  if (!follows_rays) out.view.render.max_depth = 0;
  if (out.view.render.max_depth == 0) {
    const std::string why = follows_rays
                                ? "max_depth is 0: local light only"
                                : std::string(get_word(kAlgorithms, view.render.algorithm)) + " knows local light only";
    leave_out(Feature::reflection, why);
    // Of two media that overlap, one hides surfaces of the other, at any depth.
    if (scene.media <= 1) leave_out(Feature::transmission, why);
    leave_out(Feature::nested_media, why);
    leave_out(Feature::fresnel, why);
  }
  const RenderSpec& spec = out.view.render;
  if (is_tessellated(spec) && out.features.has(Feature::spheres)) {
    const SphereCut cut = sphere_cut(scene, out.eye, spec.chord_error_px);
    leave_out(Feature::spheres, "they are drawn as triangles, " + std::to_string(cut.triangles) + " in all");
    if (cut.chord_error_px > spec.chord_error_px)
      out.plan.warnings.push_back(
          {"/render/chord_error_px", "coarser_spheres",
           "so many spheres are cut coarser, to stay at " + std::to_string(kMostSphereTriangles) + " triangles"});
    out.features.add(Feature::triangles);
    out.features.add(Feature::smooth_normals);
    out.plan.triangles_instanced += cut.triangles;
  }
  out.variant = choose_variant(out.features);
  out.plan.features = out.features;
  out.plan.kernel = variant_name(out.variant);
  if (!follows_rays) out.plan.kernel = std::string(get_word(kAlgorithms, spec.algorithm)) + ", " + out.plan.kernel;
  out.plan.isa = isa;
  out.plan.plan_ms = watch.ms();
  return out;
}

}  // namespace tilelight
