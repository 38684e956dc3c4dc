// SPDX-License-Identifier: Apache-2.0
#include "renderer/check/rows/invariance_scene.h"

#include <type_traits>

namespace tilelight::check {
namespace {

constexpr const char* kStudy = R"({
  "camera": {"position": [4.1, 4.7, 7.3], "target": [0.2, 0.45, 0.1], "fov_y_deg": 38},
  "render": {"max_depth": 3},
  "background": {"bottom": [0.5, 0.6, 0.75], "top": [0.5, 0.6, 0.75]},
  "attenuation": {"k": 6},
  "lights": [
    {"type": "point", "position": [5.3, 7.9, 3.7], "color": [1, 0.95, 0.9], "intensity": 9},
    {"type": "point", "position": [-4.1, 3.3, 2.9], "color": [0.6, 0.7, 1], "intensity": 4},
    {"type": "directional", "direction": [0.3, -1, -0.4], "intensity": 0.1}],
  "materials": {
    "ground": {"diffuse": [0.45, 0.5, 0.42]},
    "tiles": {"diffuse": {"checker": {"a": 0.85, "b": [0.2, 0.15, 0.1], "size": 0.7}}, "specular": 0.2},
    "red": {"diffuse": [0.8, 0.15, 0.1], "specular": 0.6, "shininess": 200},
    "mirror": {"diffuse": 0.1, "specular": 0.8, "shininess": 900, "reflection": 0.8},
    "ivory": {"diffuse": [0.8, 0.75, 0.6], "specular": 0.4, "shininess": 60, "reflection": 0.1},
    "blue": {"diffuse": [0.2, 0.3, 0.8], "specular": 0.3, "shininess": 20}},
  "meshes": {"octahedron": {"positions": [1,0,0, -1,0,0, 0,1,0, 0,-1,0, 0,0,1, 0,0,-1],
    "indices": [0,2,4, 2,1,4, 1,3,4, 3,0,4, 2,0,5, 1,2,5, 3,1,5, 0,3,5], "crease_deg": 120}},
  "objects": [
    {"type": "plane", "point": [0, -0.31, 0], "normal": [0, 1, 0], "material": "ground"},
    {"type": "box", "min": [-2.9, -0.31, -2.7], "max": [2.9, 0, 2.7], "material": "tiles"},
    {"type": "sphere", "center": [-0.9, 0.83, 0.2], "radius": 0.83, "material": "red"},
    {"type": "sphere", "center": [1.1, 1.02, -1.3], "radius": 1.02, "material": "mirror"},
    {"type": "sphere", "center": [0.3, 0.03, 1.9], "radius": 0.03, "material": "red"},
    {"type": "cube", "size": 0.9, "rotate_deg": {"axis": [0, 1, 0], "angle": 33}, "translate": [-1.7, 0.45, -1.6],
     "material": "blue"},
    {"type": "mesh", "mesh": "octahedron", "scale": [0.5, 0.8, 0.5], "rotate_deg": {"axis": [1, 2, 1], "angle": 20},
     "translate": [-1.3, 0.9, 1.75], "material": "ivory"},
    {"type": "chess_piece", "piece": "pawn", "position": [1.2, 0, 0.9], "detail": 10, "material": "ivory"}]})";

Mat4 uniform_scale(double s) {
  Mat4 m(s);
  m[3][3] = 1.0;
  return m;
}

void scale(Object& object, double s) {
  const bool has_fixed_size = std::holds_alternative<ChessPieceShape>(object.shape);
  std::visit(
      [s](auto& shape) {
        using Shape = std::decay_t<decltype(shape)>;
        if constexpr (std::is_same_v<Shape, SphereShape>) shape.center *= s, shape.radius *= s;
        if constexpr (std::is_same_v<Shape, BoxShape>) shape.min *= s, shape.max *= s;
        if constexpr (std::is_same_v<Shape, PlaneShape>) shape.point *= s;
      },
      object.shape);
  if (has_fixed_size) {
    object.world_from_shape = uniform_scale(s) * object.world_from_shape;
  } else {  // its coordinates are scaled already, so of its transform the translation alone
    object.world_from_shape[3] = Vec4(s * Vec3(object.world_from_shape[3]), 1.0);
    object.pivot *= s;
  }
}

void scale(Paint& paint, double s) {
  if (auto* checker = std::get_if<Checker>(&paint)) checker->size *= s;
}

void shift(Object& object, const Vec3& by) {
  const bool is_placed_by_transform = Mat3(object.world_from_shape) != Mat3(1.0);
  if (is_placed_by_transform || std::holds_alternative<MeshShape>(object.shape)) {
    object.world_from_shape[3] += Vec4(by, 0.0);
    return;
  }
  std::visit(
      [&by](auto& shape) {
        using Shape = std::decay_t<decltype(shape)>;
        if constexpr (std::is_same_v<Shape, SphereShape>) shape.center += by;
        if constexpr (std::is_same_v<Shape, BoxShape>) shape.min += by, shape.max += by;
        if constexpr (std::is_same_v<Shape, PlaneShape>) shape.point += by;
        if constexpr (std::is_same_v<Shape, ChessPieceShape>) shape.position += by;
      },
      object.shape);
}

}  // namespace

ParsedScene study(int size_px, AttenuationMode attenuation) {
  ParsedScene parsed = scene_of(kStudy);
  parsed.view.image.width = parsed.view.image.height = size_px;
  if (attenuation == AttenuationMode::inverse_square) {
    parsed.scene.attenuation = {attenuation, 20.0};
    for (Light& light : parsed.scene.lights)
      if (light.kind == LightKind::point) light.intensity *= 9.0;
  }
  return parsed;
}

ParsedScene scaled(ParsedScene parsed, double s) {
  Scene& scene = parsed.scene;
  const double fall = scene.attenuation.mode == AttenuationMode::linear           ? s
                      : scene.attenuation.mode == AttenuationMode::inverse_square ? s * s
                                                                                  : 1.0;
  scene.attenuation.k *= fall;
  for (Light& light : scene.lights) {
    if (light.kind == LightKind::directional) continue;
    light.position *= s;
    light.intensity *= fall;
  }
  for (Object& object : scene.objects) scale(object, s);
  for (MeshData& mesh : scene.meshes)
    for (Vec3& p : mesh.positions) p *= s;
  for (Material& material : scene.materials) scale(material.ambient, s), scale(material.diffuse, s);
  Camera& camera = *parsed.view.camera;
  camera.position *= s, camera.target *= s, camera.height *= s;
  return parsed;
}

ParsedScene shifted(ParsedScene parsed, const Vec3& by) {
  for (Object& object : parsed.scene.objects) shift(object, by);
  for (Light& light : parsed.scene.lights) light.position += by;
  parsed.view.camera->position += by, parsed.view.camera->target += by;
  return parsed;
}

ParsedScene turned(ParsedScene parsed, const Mat3& m) {
  for (Object& object : parsed.scene.objects) object.world_from_shape = Mat4(m) * object.world_from_shape;
  for (Light& light : parsed.scene.lights) light.position = m * light.position, light.direction = m * light.direction;
  Camera& camera = *parsed.view.camera;
  camera.position = m * camera.position, camera.target = m * camera.target, camera.up = m * camera.up;
  return parsed;
}

TextbookTracer::Picture textbook_picture(const ParsedScene& parsed, TilePool& pool, float epsilon) {
  return TextbookTracer(parsed.scene, epsilon).picture(parsed.view, *parsed.view.camera, pool);
}

}  // namespace tilelight::check
