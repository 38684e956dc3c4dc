// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include <glm/gtc/matrix_access.hpp>

#include "renderer/base/standard_floats.h"
#include "renderer/compile/compile.h"
#include "renderer/compile/compiled_scene.h"
#include "renderer/compile/cost_text.h"
#include "renderer/compile/reach.h"
#include "renderer/compile/stopwatch.h"
#include "renderer/compile/tessellate.h"
#include "renderer/scene/camera_up.h"
#include "renderer/scene/words.h"

namespace tilelight {
namespace {

// A convex body that is alone in the picture, seen from outside: where a light shines on it nothing of it stands
// between, and what it mirrors is not itself.
bool is_convex_seen_from_outside(const CompiledScene& scene, const Eye& eye, const Reach& reach) {
  if (reach.count() != 1) return false;
  const auto alone = std::find(reach.casts.begin(), reach.casts.end(), true) - reach.casts.begin();
  const CompiledBody& body = scene.bodies[static_cast<size_t>(alone)];
  if (scene.materials[body.material].is_transmissive) return false;
  if (body.kind == BodyKind::plane) return true;
  if (eye.projection == Projection::orthographic) return false;  // its rays start in many places
  const Vec3 at = glm::abs(transform_point(body.local_from_world, eye.origin));
  constexpr double kClearly = 1.0 + 0x1p-20;
  if (body.kind == BodyKind::sphere) return glm::dot(at, at) > kClearly;
  const Vec3 half = kClearly * body.half;
  return body.kind == BodyKind::box && (at.x > half.x || at.y > half.y || at.z > half.z);
}

// By name if they are few, else how many there are.
void leave_out_bodies(const CompiledScene& scene, const Reach& reach, std::vector<LeftOut>& left_out) {
  constexpr size_t kMostNames = 4;
  const std::string why = "outside the picture, and no shadow or mirrored ray leads there";
  const size_t count = scene.bodies.size() - reach.count();
  if (count > kMostNames) left_out.push_back({std::to_string(count) + " bodies", "they lie " + why});
  for (size_t i = 0; i < scene.bodies.size() && count <= kMostNames; ++i) {
    if (!reach.casts[i]) left_out.push_back({"body " + scene.bodies[i].name, "it lies " + why});
  }
}

SceneWarning up_warning(const Camera& camera) {
  const Vec3 up = usable_up(camera);
  return {"/camera", "up_parallel_to_view",
          std::string("up is parallel to the view; ") +
              (up.y > 0.0   ? "+y"
               : up.z > 0.0 ? "+z"
                            : "-z") +
              " takes its place"};
}

class ViewPlanner {
 public:
  ViewPlanner(const CompiledScene& scene, const View& view) : scene_(scene) {
    out_.view = view;
    out_.plan = scene.plan;
    out_.features = scene.plan.features;
  }

  ViewPlan make(std::string_view isa) {
    set_eye();
    leave_out_unreached();
    leave_out_unasked();
    if (is_tessellated(spec())) cut_spheres();
    set_costs();
    out_.variant = choose_variant(out_.features);
    out_.plan.features = out_.features;
    out_.plan.kernel = variant_name(out_.variant);
    if (!follows_rays())
      out_.plan.kernel = std::string(get_word(kAlgorithms, spec().algorithm)) + ", " + out_.plan.kernel;
    out_.plan.isa = isa;
    return std::move(out_);
  }

 private:
  const RenderSpec& spec() const { return out_.view.render; }
  bool follows_rays() const { return spec().algorithm == Algorithm::raytrace; }

  void leave_out(Feature feature, const std::string& why, const std::string& cost = {}) {
    if (!out_.features.has(feature)) return;
    out_.features.remove(feature);
    out_.plan.left_out.push_back(left_out_feature(feature, why, cost));
  }

  void set_eye() {
    const ImageSpec& image = out_.view.image;
    out_.camera = out_.view.camera ? *out_.view.camera : framed_camera(scene_, image.width, image.height);
    out_.view.camera = out_.camera;
    if (is_up_along_view(out_.camera)) out_.plan.warnings.push_back(up_warning(out_.camera));
    out_.eye = make_eye(out_.camera, image.width, image.height, scene_.center, scene_.units);
    std::vector<Vec4> planes;
    for (size_t i = scene_.finite_bodies; i < scene_.bodies.size(); ++i)
      planes.push_back(glm::row(scene_.bodies[i].local_from_world, 1));  // y = 0 in its own space
    start_near_bodies(out_.eye, (out_.camera.target - scene_.center) / scene_.units, image.width, image.height, planes);
    if (!follows_rays()) out_.view.render.max_depth = 0;
  }

  // Bodies that no ray of the picture meets, and what only they would need.
  void leave_out_unreached() {
    const Reach reach = find_reach(scene_, out_);
    leave_out_bodies(scene_, reach, out_.plan.left_out);
    const FeatureSet needed = features_of(scene_, reach);
    for (int i = 0; i < kFeatureCount; ++i) {
      const auto feature = static_cast<Feature>(i);
      if (!needed.has(feature)) leave_out(feature, "nothing that has a part in the picture needs it");
    }
    hides_nothing_ = is_convex_seen_from_outside(scene_, out_.eye, reach);
  }

  void leave_out_unasked() {
    const auto casting = std::count_if(scene_.lights.begin(), scene_.lights.end(),
                                       [](const CompiledLight& light) { return light.shadow; });
    const std::string shadow_rays = first_hits_text(out_.view, casting, "shadow rays");
    if (!spec().shadows) {
      leave_out(Feature::shadows, "the view asks for none", shadow_rays);
      leave_out(Feature::tinted_shadows, "the view asks for no shadows");
    }
    if (hides_nothing_)
      leave_out(Feature::shadows, "a single convex body, seen from outside, hides nothing of itself from a light",
                shadow_rays);
    if (spec().max_depth > 0) return;
    const std::string why = follows_rays()
                                ? "max_depth is 0: local light only"
                                : std::string(get_word(kAlgorithms, spec().algorithm)) + " knows local light only";
    leave_out(Feature::reflection, why, first_hits_text(out_.view, 1, "reflected rays"));
    // Of two media that overlap, or two shells of one, one hides surfaces of the other, at any depth.
    const auto hides_own = [](const CompiledBody& body) { return body.may_touch_itself; };
    if (scene_.media <= 1 && std::none_of(scene_.bodies.begin(), scene_.bodies.end(), hides_own))
      leave_out(Feature::transmission, why, first_hits_text(out_.view, 1, "refracted rays"));
    leave_out(Feature::nested_media, why);
    leave_out(Feature::fresnel, why);
  }

  // Of what the scene had left out before the view was known, or what the kernel need not do.
  void set_costs() {
    for (LeftOut& item : out_.plan.left_out) {
      if (!item.cost.empty()) continue;
      if (item.kind == LeftOut::Kind::light) {
        item.cost = first_hits_text(out_.view, 1, "evaluations of the light equation");
      } else if (item.kind == LeftOut::Kind::feature && follows_rays()) {
        item.cost = kernel_cost_text(out_.features, item.feature).value_or("");
      }
    }
  }

  void cut_spheres() {
    if (!out_.features.has(Feature::spheres)) return;
    const SphereCut cut = sphere_cut(scene_, out_.eye, spec().chord_error_px);
    leave_out(Feature::spheres, "they are drawn as triangles, " + std::to_string(cut.triangles) + " in all");
    if (cut.chord_error_px > spec().chord_error_px)
      out_.plan.warnings.push_back(
          {"/render/chord_error_px", "coarser_spheres",
           "so many spheres are cut coarser, to stay at " + std::to_string(kMostSphereTriangles) + " triangles"});
    out_.features.add(Feature::triangles);
    out_.features.add(Feature::smooth_normals);
    out_.plan.triangles_instanced += cut.triangles;
  }

  const CompiledScene& scene_;
  ViewPlan out_;
  bool hides_nothing_ = false;  // what has a part in the picture, from a light
};

}  // namespace

ViewPlan plan_view(const CompiledScene& scene, const View& view, std::string_view isa) {
  const StandardFloats floats;
  const Stopwatch watch;
  ViewPlan out = ViewPlanner(scene, view).make(isa);
  out.plan.plan_ms = watch.ms();
  return out;
}

}  // namespace tilelight
