// SPDX-License-Identifier: Apache-2.0
// pov_scene: a scene as POV-Ray reads it, on standard output: the same triangles, spheres, boxes and planes, camera,
// lights and materials. What POV-Ray has no words for is made plain: lights do not fade and have everywhere the
// brightness that they have at the camera's target, a checker is its first colour and the background its upper one,
// and nothing is transparent.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <string>

#include <CLI/CLI.hpp>

#include "renderer/compile/bodies.h"
#include "renderer/renderer.h"
#include "tests/bench/bench_scene.h"

namespace tilelight::bench {
namespace {

void print(const Vec3& v) { std::printf("<%.9g,%.9g,%.9g>", v.x, v.y, v.z); }
void print_color(const Color& c) { std::printf("rgb <%.9g,%.9g,%.9g>", c.r, c.g, c.b); }

Color color_of(const Paint& paint) {
  const auto* color = std::get_if<Color>(&paint);
  return color ? *color : std::get<Checker>(paint).a;
}

// Three normals a triangle, as given; none for a flat mesh.
void print_mesh(const TriMesh& mesh, size_t index) {
  std::printf("#declare Mesh%zu = mesh2 { vertex_vectors { %zu", index, mesh.positions.size());
  for (const Vec3& p : mesh.positions) std::printf(","), print(p);
  std::printf(" }\n");
  if (!mesh.corner_normals.empty()) {
    std::printf("normal_vectors { %zu", 3 * mesh.corner_normals.size());
    for (const auto& corners : mesh.corner_normals)
      for (const Vec3& n : corners) std::printf(","), print(n);
    std::printf(" }\n");
  }
  std::printf("face_indices { %zu", mesh.triangles.size());
  for (const auto& t : mesh.triangles) std::printf(",<%u,%u,%u>", t[0], t[1], t[2]);
  std::printf(" }\n");
  if (!mesh.corner_normals.empty()) {
    std::printf("normal_indices { %zu", mesh.triangles.size());
    for (size_t t = 0; t < mesh.triangles.size(); ++t) std::printf(",<%zu,%zu,%zu>", 3 * t, 3 * t + 1, 3 * t + 2);
    std::printf(" }\n");
  }
  std::printf("}\n");
}

void print_material(const Material& m, const Color& ambient) {
  const Color diffuse = color_of(m.diffuse);
  std::printf("pigment { ");
  print_color(diffuse);
  std::printf(" } finish { ambient ");
  print_color(ambient);
  std::printf(" diffuse 1 phong %.9g phong_size %.9g reflection { ", m.specular.g, m.shininess);
  print_color(m.reflection);
  std::printf(" } }");
}

void print_body(const Body& body, const Scene& scene, const std::map<const TriMesh*, size_t>& meshes) {
  switch (body.kind) {
    case BodyKind::sphere:
      std::printf("sphere { 0, 1");
      break;
    case BodyKind::box:
      std::printf("box { ");
      print(-body.half), std::printf(", "), print(body.half);
      break;
    case BodyKind::plane:
      std::printf("plane { y, 0");
      break;
    case BodyKind::mesh:
      std::printf("object { Mesh%zu", meshes.at(body.mesh.get()));
      break;
  }
  std::printf(" matrix <");
  for (int column = 0; column < 4; ++column) {
    const Vec4& c = body.world_from_local[column];
    std::printf("%s%.9g,%.9g,%.9g", column ? ", " : "", c.x, c.y, c.z);
  }
  std::printf("> ");
  print_material(scene.materials[body.material], scene.ambient);
  std::printf(" }\n");
}

// POV-Ray's space is left-handed: `right` points the other way.
void print_camera(const Camera& camera, const ImageSpec& image) {
  const double aspect = static_cast<double>(image.width) / image.height;
  const double half = std::atan(std::tan(camera.fov_y_deg * M_PI / 360.0) * aspect);
  std::printf("camera { location ");
  print(camera.position);
  std::printf(" right -x*%.9g sky ", aspect);
  print(camera.up);
  std::printf(" angle %.9g look_at ", half * 360.0 / M_PI);
  print(camera.target);
  std::printf(" }\n");
}

void print_light(const Light& light, const Attenuation& attenuation, const Vec3& target) {
  const double d = glm::length(light.position - target);
  double factor = 1.0;
  if (light.kind == LightKind::point && attenuation.mode == AttenuationMode::linear) factor = 1.0 / (d + attenuation.k);
  if (light.kind == LightKind::point && attenuation.mode == AttenuationMode::inverse_square)
    factor = 1.0 / (d * d + attenuation.k);
  std::printf("light_source { ");
  print(light.kind == LightKind::point ? light.position : -1e6 * glm::normalize(light.direction));
  std::printf(", ");
  print_color(light.color * light.intensity * factor);
  std::printf("%s%s }\n", light.kind == LightKind::directional ? " parallel" : "", light.shadow ? "" : " shadowless");
}

int run(const std::string& document) {
  const auto parsed = parse_scene(document, Limits{});
  if (!parsed) {
    std::cerr << "pov_scene: " << parsed.error().errors[0].detail << "\n";
    return 1;
  }
  TilePool pool(1);
  const auto compiled = compile_scene(parsed->scene, pool);
  const ImageSpec& image = parsed->view.image;
  const Camera camera =
      parsed->view.camera ? *parsed->view.camera : framed_camera(*compiled, image.width, image.height);
  const Scene& scene = parsed->scene;
  std::printf("#version 3.7;\nglobal_settings { assumed_gamma 1 max_trace_level %d adc_bailout %.9g }\nbackground { ",
              parsed->view.render.max_depth + 1, parsed->view.render.weight_cutoff);
  print_color(scene.background.top);
  std::printf(" }\n");
  print_camera(camera, image);
  for (const Light& light : scene.lights) print_light(light, scene.attenuation, camera.target);
  const std::vector<Body> bodies = make_bodies(scene);
  std::map<const TriMesh*, size_t> meshes;
  for (const Body& body : bodies) {
    if (body.mesh && meshes.try_emplace(body.mesh.get(), meshes.size()).second)
      print_mesh(*body.mesh, meshes.at(body.mesh.get()));
  }
  for (const Body& body : bodies) print_body(body, scene, meshes);
  return 0;
}

}  // namespace
}  // namespace tilelight::bench

int main(int argc, char** argv) {
  CLI::App app{"A scene as POV-Ray reads it"};
  std::string path = "s";
  bool as_json = false;
  app.add_option("scene", path, "A scene file, or s, m, l: a scene of the benchmarks")->capture_default_str();
  app.add_flag("--json", as_json, "The document itself instead");
  CLI11_PARSE(app, argc, argv);
  std::string document;
  if (path == "s" || path == "m" || path == "l") {
    document = tilelight::bench::bench_scene(tilelight::bench::detail_of(path[0]));
  } else {
    std::ifstream file(path);
    if (!file) {
      std::cerr << "pov_scene: cannot read " << path << "\n";
      return 1;
    }
    document.assign(std::istreambuf_iterator<char>(file), {});
  }
  if (as_json) {
    std::cout << document << "\n";
    return 0;
  }
  return tilelight::bench::run(document);
}
