// SPDX-License-Identifier: Apache-2.0
#include "renderer/study/pov_scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "renderer/base/elementary.h"
#include "renderer/base/safe_length.h"
#include "renderer/compile/eye.h"
#include "renderer/study/pov_features.h"
#include "renderer/study/pov_mesh.h"
#include "renderer/study/pov_space.h"
#include "renderer/study/pov_text.h"
#include "renderer/study/pov_texture.h"

namespace tilelight {
namespace {

constexpr int kMostLevels = 256;     // POV-Ray's max_trace_level goes no further
constexpr double kFarLight = 1e6;    // of directional lights, POV-Ray's units
constexpr double kLeastFade = 1e-4;  // fade_distance where k is 0; light comes from farther off

// A ray that meets no change of index goes on in POV-Ray without counting as a secondary one. So what bends nothing
// bends a millionth, each body by another one.
double counted_ior(const Body& body, const Material& m, size_t index) {
  constexpr double kLeast = 1e-6;
  const double ior = body.has_inside ? m.ior : 1.0;
  return std::abs(ior - 1.0) < kLeast ? 1.0 + kLeast * static_cast<double>(1 + index % 64) : ior;
}

bool is_checkered(const Material& m) {
  return std::holds_alternative<Checker>(m.diffuse) || std::holds_alternative<Checker>(m.ambient);
}

class Writer {
 public:
  Writer(const Scene& scene, const View& view)
      : scene_(scene),
        view_(view),
        bodies_(make_bodies(scene)),
        space_(pov_space(bodies_, *view.camera)),
        exposure_(elementary::exp2(view.image.exposure)),
        textures_(scene, exposure_) {}

  PovScene write() {
    for (const Body& body : bodies_) add_body(body);
    PovText text;
    text.add("#version 3.7;\nglobal_settings { assumed_gamma 1 max_trace_level %d adc_bailout %.9g }\n",
             std::min(view_.render.max_depth + 1, kMostLevels), view_.render.weight_cutoff);
    add_background(text);
    add_camera(text);
    text.add(textures_.declarations());
    text.add(meshes_.str());
    if (has_light_through()) {
      // Declared once more, for lights that are to shine through them.
      text.add("#declare Everything = union {\n" + objects_.str() + "}\n");
    }
    for (const Light& light : scene_.lights) add_light(text, light);
    text.add(objects_.str());
    return {text.str(), pov_notes({scene_, view_, bodies_, space_})};
  }

 private:
  void add_background(PovText& text) const {
    text.add("sky_sphere { pigment { gradient y color_map { [0 "), text.color(scene_.background.bottom * exposure_);
    text.add("] [1 "), text.color(scene_.background.top * exposure_);
    text.add("] } scale 2.00002 translate -1.00001 } }\n");  // a gradient starts anew at 1
  }

  // With all three axes, so that POV-Ray has nothing to work out.
  void add_camera(PovText& text) const {
    const ImageSpec& image = view_.image;
    const Eye eye = make_eye(*view_.camera, image.width, image.height, space_.center, 1.0 / space_.scale);
    text.add("camera { %s location ", eye.projection == Projection::orthographic ? "orthographic" : "perspective");
    text.vector(eye.origin);
    text.add(" direction "), text.vector(eye.forward);
    text.add(" right "), text.vector(eye.step_x * static_cast<double>(image.width));
    text.add(" up "), text.vector(-eye.step_y * static_cast<double>(image.height));
    text.add(" }\n");
  }

  bool is_glossy() const {
    return std::any_of(bodies_.begin(), bodies_.end(),
                       [&](const Body& body) { return scene_.materials[body.material].specular != Color(0.0); });
  }
  bool casts_shadow(const Light& light) const { return light.shadow && view_.render.shadows; }
  bool has_shadows() const {
    return std::any_of(scene_.lights.begin(), scene_.lights.end(), [&](const Light& l) { return casts_shadow(l); });
  }
  // POV-Ray's `shadowless` lights make no highlights. Where no light casts shadows the objects say so; a directional
  // light without shadow stands behind everything; only a point light needs more.
  bool shines_through(const Light& light) const {
    return light.kind == LightKind::point && !casts_shadow(light) && has_shadows() && is_glossy();
  }
  bool has_light_through() const {
    return std::any_of(scene_.lights.begin(), scene_.lights.end(), [&](const Light& l) { return shines_through(l); });
  }

  void add_light(PovText& text, const Light& light) const {
    text.add("light_source { ");
    light.kind == LightKind::point ? add_point_light(text, light) : add_directional_light(text, light);
    text.add(" }\n");
  }

  // POV-Ray's light falls off by 2 / (1 + (d / fade_distance)^fade_power), ours by 1 / (d + k) or 1 / (d^2 + k).
  void add_point_light(PovText& text, const Light& light) const {
    const auto& [mode, k] = scene_.attenuation;
    Color color = light.color * light.intensity * exposure_;
    const bool is_linear = mode == AttenuationMode::linear;
    const double fade = std::max((is_linear ? k : std::sqrt(k)) * space_.scale, kLeastFade);
    const double near = space_.scale / fade;
    if (mode != AttenuationMode::none) color *= 0.5 * (is_linear ? near : near * near);
    const Vec3 place = space_.point(light.position);
    text.vector(place), text.add(", "), text.color(color);
    if (mode != AttenuationMode::none) text.add(" fade_distance %.12g fade_power %d", fade, is_linear ? 1 : 2);
    if (!casts_shadow(light) && has_shadows() && !is_glossy()) text.add(" shadowless");
    if (!shines_through(light)) return;
    // The light's beams count from where they last meet this object: whatever is met on the way, or a bead around the
    // light. Nothing is left between there and a surface.
    text.add(" projected_through { union { object { Everything } sphere { "), text.vector(place);
    text.add(", 0.01 } } }");
  }

  // Beams of a parallel light come from a plane through its place; behind that they go on without shadow.
  void add_directional_light(PovText& text, const Light& light) const {
    const Vec3 way = safe_normalize(light.direction);
    const Vec3 place = (casts_shadow(light) ? -kFarLight : kFarLight) * way;
    text.vector(place), text.add(", "), text.color(light.color * light.intensity * exposure_);
    text.add(" parallel point_at "), text.vector(place + way * 1e3);
  }

  void add_body(const Body& body) {
    const Material& material = scene_.materials[body.material];
    const bool is_flat_box = body.kind == BodyKind::box && !body.has_inside;
    if (body.kind == BodyKind::mesh) {
      add_mesh_body(body, *body.mesh, body.mesh.get());
    } else if (body.kind == BodyKind::box && (is_flat_box || is_checkered(material))) {
      add_mesh_body(body, box_mesh(body.half), nullptr);
    } else {
      add_solid(body);
    }
  }

  // Spheres, boxes and planes along the axes as such: POV-Ray is faster with them than through a matrix.
  void add_solid(const Body& body) {
    const Mat4 place = space_.from_local(body.world_from_local);
    const Mat3 linear(place);
    const Vec3 middle(place[3]);
    const bool is_upright = linear == Mat3(linear[0][0], 0, 0, 0, linear[1][1], 0, 0, 0, linear[2][2]);
    const Vec3 sides = glm::abs(Vec3(linear[0][0], linear[1][1], linear[2][2]));
    if (body.kind == BodyKind::plane) {
      const Vec3 normal = safe_normalize(glm::transpose(glm::inverse(linear)) * Vec3(0, 1, 0));
      objects_.add("plane { "), objects_.vector(normal);
      objects_.add(", %.12g", glm::dot(normal, middle));
    } else if (body.kind == BodyKind::sphere && is_upright && sides.x == sides.y && sides.x == sides.z) {
      objects_.add("sphere { "), objects_.vector(middle), objects_.add(", %.12g", sides.x);
    } else if (body.kind == BodyKind::sphere) {
      objects_.add("sphere { 0, 1"), objects_.matrix(place);
    } else if (is_upright) {
      objects_.add("box { "), objects_.vector(middle - sides * body.half), objects_.add(", ");
      objects_.vector(middle + sides * body.half);
    } else {
      Mat4 unit_box = place;
      for (int axis = 0; axis < 3; ++axis) unit_box[axis] *= body.half[axis];
      objects_.add("box { -1, 1"), objects_.matrix(unit_box);
    }
    const int flat_axis = body.kind == BodyKind::plane ? 1 : 3;
    objects_.add(" texture { " + textures_.name_of(body.material, {body.has_inside, flat_axis}));
    if (is_checkered(scene_.materials[body.material])) objects_.matrix(place * glm::inverse(body.pattern_from_local));
    objects_.add(" }");
    end_body(body);
  }

  // key: of a mesh that other bodies may share; null: of this body alone.
  void add_mesh_body(const Body& body, const TriMesh& mesh, const TriMesh* key) {
    const bool has_faces = is_checkered(scene_.materials[body.material]);
    if (mesh.triangles.empty()) return;
    const PovMeshSpace space = pov_mesh_space(mesh, kPovSceneSize);
    std::optional<PovFaceTextures> faces;
    if (has_faces) {
      PovText to_mesh;
      to_mesh.matrix(space.mesh_from_local * glm::inverse(body.pattern_from_local));
      faces.emplace();
      for (int axis = 0; axis < 3; ++axis)
        (*faces)[axis] = textures_.name_of(body.material, {body.has_inside, axis}) + to_mesh.str();
    }
    objects_.add("object { " + mesh_name(mesh, key, space, has_faces ? &body : nullptr, faces));
    if (!has_faces) objects_.add(" texture { " + textures_.name_of(body.material, {body.has_inside, 3}) + " }");
    objects_.matrix(space_.from_local(body.world_from_local * space.local_from_mesh));
    end_body(body);
  }

  // Declares the mesh where it is met first.
  std::string mesh_name(const TriMesh& mesh, const TriMesh* key, const PovMeshSpace& space, const Body* textured,
                        const std::optional<PovFaceTextures>& faces) {
    const auto material = textured ? std::optional(textured->material) : std::nullopt;
    std::string name = "Mesh" + std::to_string(mesh_count_);
    if (key) {
      const auto [known, is_new] = mesh_names_.try_emplace({key, material, textured && textured->has_inside}, name);
      if (!is_new) return known->second;
    }
    ++mesh_count_;
    meshes_.add("#declare " + name + " = " + pov_mesh(mesh, space, faces) + "\n");
    return name;
  }

  void end_body(const Body& body) {
    const Material& m = scene_.materials[body.material];
    const auto index = static_cast<size_t>(&body - bodies_.data());
    if (m.transmission != Color(0.0)) objects_.add(" interior { ior %.9g }", counted_ior(body, m, index));
    if (!scene_.lights.empty() && !has_shadows()) objects_.add(" no_shadow");
    objects_.add(" }\n");
  }

  const Scene& scene_;
  const View& view_;
  const std::vector<Body> bodies_;
  const PovSpace space_;
  const double exposure_;  // what all light is multiplied by, for POV-Ray's pictures end at 1
  PovTextures textures_;
  std::map<std::tuple<const TriMesh*, std::optional<MaterialId>, bool>, std::string> mesh_names_;
  size_t mesh_count_ = 0;
  PovText meshes_, objects_;
};

}  // namespace

PovScene pov_scene(const Scene& scene, const View& view) { return Writer(scene, view).write(); }

}  // namespace tilelight
