// SPDX-License-Identifier: Apache-2.0
#include "renderer/study/pov_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <map>
#include <set>

#include "renderer/base/elementary.h"
#include "renderer/compile/bodies.h"
#include "renderer/scene/camera_up.h"

namespace tilelight {
namespace {

class Writer {
 public:
  Writer(const Scene& scene, const View& view)
      : scene_(scene), camera_(*view.camera), image_(view.image), render_(view.render) {}

  PovScene write() {
    add("#version 3.7;\nglobal_settings { assumed_gamma 1 max_trace_level %d adc_bailout %.9g }\n",
        render_.max_depth + 1, render_.weight_cutoff);
    add_background();
    add_camera();
    for (const Light& light : scene_.lights) add_light(light);
    const std::vector<Body> bodies = make_bodies(scene_);
    for (const Body& body : bodies) {
      if (body.mesh && meshes_.try_emplace(body.mesh.get(), meshes_.size()).second) add_mesh(*body.mesh);
    }
    for (const Body& body : bodies) add_body(body);
    return {std::move(text_), {differences_.begin(), differences_.end()}};
  }

 private:
  __attribute__((format(printf, 2, 3))) void add(const char* format, ...) {
    char part[512];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(part, sizeof part, format, arguments);
    va_end(arguments);
    text_ += part;
  }
  void add(const Vec3& v) { add("<%.9g,%.9g,%.9g>", v.x, v.y, v.z); }
  void add_color(const Color& c) { add("rgb <%.9g,%.9g,%.9g>", c.r, c.g, c.b); }
  void add_matrix(const Mat4& m) {
    add(" matrix <");
    for (int column = 0; column < 4; ++column) {
      const Vec4& c = m[column];
      add("%s%.9g,%.9g,%.9g", column ? ", " : "", c.x, c.y, c.z);
    }
    add(">");
  }

  void add_background() {
    add("sky_sphere { pigment { gradient y color_map { [0 ");
    add_color(scene_.background.bottom);
    add("] [1 ");
    add_color(scene_.background.top);
    add("] } scale 2.00002 translate -1.00001 } }\n");  // a gradient starts anew at 1
  }

  // POV-Ray's space is left-handed: `right` points the other way.
  void add_camera() {
    const double aspect = static_cast<double>(image_.width) / image_.height;
    if (camera_.projection == Projection::orthographic) {
      add("camera { orthographic location ");
      add(camera_.position);
      add(" right -x*%.9g up y*%.9g sky ", camera_.height * aspect, camera_.height);
      add(usable_up(camera_));
    } else {
      const double half_width = elementary::tan(elementary::rad_from_deg(0.5 * camera_.fov_y_deg)) * aspect;
      add("camera { location ");
      add(camera_.position);
      add(" right -x*%.9g sky ", aspect);
      add(usable_up(camera_));
      add(" angle %.9g", 2.0 * elementary::atan2(half_width, 1.0) / elementary::rad_from_deg(1.0));
    }
    add(" look_at ");
    add(camera_.target);
    add(" }\n");
  }

  // Its light falls off by 2 / (1 + (d / fade_distance)^fade_power), ours by 1 / (d + K) or 1 / (d^2 + K).
  void add_light(const Light& light) {
    const auto& [mode, k] = scene_.attenuation;
    const bool is_point = light.kind == LightKind::point;
    const bool fades = is_point && mode != AttenuationMode::none;
    double factor = 1.0;
    if (fades && k > 0.0) factor = 0.5 / k;
    if (fades && !(k > 0.0)) {
      const double d = glm::length(light.position - camera_.target);
      factor = mode == AttenuationMode::linear ? 1.0 / d : 1.0 / (d * d);
      differences_.insert("lights that fade with K = 0 are as bright everywhere as at the camera's target");
    }
    add("light_source { ");
    add(is_point ? light.position : camera_.target - 1e6 * glm::normalize(light.direction));
    add(", ");
    add_color(light.color * light.intensity * factor);
    if (fades && k > 0.0) {
      const bool is_linear = mode == AttenuationMode::linear;
      add(" fade_distance %.9g fade_power %d", is_linear ? k : std::sqrt(k), is_linear ? 1 : 2);
    }
    if (!is_point) {
      add(" parallel point_at ");
      add(camera_.target);
    }
    add("%s }\n", light.shadow && render_.shadows ? "" : " shadowless");
  }

  // Three normals a triangle, as given; none for a flat mesh.
  void add_mesh(const TriMesh& mesh) {
    add("#declare Mesh%zu = mesh2 { vertex_vectors { %zu", meshes_.at(&mesh), mesh.positions.size());
    for (const Vec3& p : mesh.positions) add(","), add(p);
    add(" }\n");
    if (!mesh.corner_normals.empty()) {
      add("normal_vectors { %zu", 3 * mesh.corner_normals.size());
      for (const auto& corners : mesh.corner_normals)
        for (const Vec3& n : corners) add(","), add(n);
      add(" }\n");
    }
    add("face_indices { %zu", mesh.triangles.size());
    for (const auto& t : mesh.triangles) add(",<%u,%u,%u>", t[0], t[1], t[2]);
    add(" }\n");
    if (!mesh.corner_normals.empty()) {
      add("normal_indices { %zu", mesh.triangles.size());
      for (size_t t = 0; t < mesh.triangles.size(); ++t) add(",<%zu,%zu,%zu>", 3 * t, 3 * t + 1, 3 * t + 2);
      add(" }\n");
    }
    add("}\n");
  }

  void add_pigment(const Paint& paint, const Body& body) {
    add(" pigment { ");
    if (const auto* color = std::get_if<Color>(&paint)) {
      add_color(*color);
    } else {
      const Checker& checker = std::get<Checker>(paint);
      add("checker ");
      add_color(checker.a);
      add(" ");
      add_color(checker.b);
      add(" scale %.9g", checker.size);
      add_matrix(glm::inverse(body.pattern_from_local));
      if (body.kind == BodyKind::box || body.kind == BodyKind::mesh)
        differences_.insert("checkers on boxes and meshes have cells in three dimensions");
    }
    add(" }");
  }

  // Its ambient light is multiplied by the pigment: what ours is to diffuse.
  Color ambient_over_diffuse(const Material& m) {
    const auto first = [](const Paint& paint) {
      const auto* color = std::get_if<Color>(&paint);
      return color ? *color : std::get<Checker>(paint).a;
    };
    const Color diffuse = first(m.diffuse), ambient = first(m.ambient) * scene_.ambient;
    Color out{0.0};
    for (int c = 0; c < 3; ++c) {
      if (diffuse[c] > 0.0) out[c] = ambient[c] / diffuse[c];
      if (!(diffuse[c] > 0.0) && ambient[c] > 0.0)
        differences_.insert("a colour that reflects no diffuse light has no ambient one");
    }
    return out;
  }

  void add_material(const Body& body) {
    const Material& m = scene_.materials[body.material];
    add_pigment(m.diffuse, body);
    add(" finish { ambient ");
    add_color(ambient_over_diffuse(m));
    add(" diffuse 1 phong %.9g phong_size %.9g reflection { ", m.specular.g, m.shininess);
    add_color(m.reflection);
    add(" } }");
    if (m.specular.r != m.specular.g || m.specular.b != m.specular.g)
      differences_.insert("highlights are as strong in every channel as in green");
    if (m.transmission != Color(0.0)) differences_.insert("nothing is transparent");
  }

  void add_body(const Body& body) {
    switch (body.kind) {
      case BodyKind::sphere:
        add("sphere { 0, 1");
        break;
      case BodyKind::box:
        add("box { ");
        add(-body.half), add(", "), add(body.half);
        break;
      case BodyKind::plane:
        add("plane { y, 0");
        break;
      case BodyKind::mesh:
        add("object { Mesh%zu", meshes_.at(body.mesh.get()));
        break;
    }
    add_material(body);
    add_matrix(body.world_from_local);
    add(" }\n");
  }

  const Scene& scene_;
  const Camera camera_;
  const ImageSpec image_;
  const RenderSpec render_;
  std::map<const TriMesh*, size_t> meshes_;
  std::set<std::string> differences_;
  std::string text_;
};

}  // namespace

PovScene pov_scene(const Scene& scene, const View& view) { return Writer(scene, view).write(); }

}  // namespace tilelight
