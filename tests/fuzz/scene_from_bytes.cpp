// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/scene_from_bytes.h"

#include <fuzzer/FuzzedDataProvider.h>

#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>
#include <variant>

namespace tilelight::fuzz {
namespace {

class Maker {
 public:
  Maker(const uint8_t* data, size_t size) : bytes_(data, size) {}

  SceneAndView make() {
    make_surroundings();
    for (int i = 0; i < 4; ++i) add_material();
    add_meshes();
    const int lights = pick(4), objects = 1 + pick(5);
    for (int i = 0; i < lights; ++i) add_light();
    for (int i = 0; i < objects; ++i) add_object();
    View view = make_view();
    return {std::move(scene_), std::move(view)};
  }

 private:
  int pick(int count) { return bytes_.ConsumeIntegralInRange<int>(0, count - 1); }
  bool coin() { return bytes_.ConsumeBool(); }
  double unit() { return bytes_.ConsumeIntegral<uint16_t>() / 65535.0; }
  double between(double low, double high) { return low + (high - low) * unit(); }

  // On the grid, or anywhere.
  double place(double reach) {
    return coin() ? 0.5 * std::round(between(-2.0 * reach, 2.0 * reach)) : between(-reach, reach);
  }
  Vec3 point(double reach) {
    const double x = place(reach), y = place(reach);
    return {x, y, place(reach)};
  }
  Vec3 direction() {
    const Vec3 v = point(1.0);
    return v == Vec3(0.0) ? Vec3(0.0, 1.0, 0.0) : v;
  }
  Color color(double high) {
    if (coin()) return Color(high * pick(3) / 2.0);
    const double r = between(0.0, high), g = between(0.0, high);
    return {r, g, between(0.0, high)};
  }
  // Of everyday size, or a thousand times off.
  double size() { return between(0.1, 2.0) * (pick(8) == 0 ? (coin() ? 1e-3 : 1e3) : 1.0); }

  void make_surroundings() {
    scene_.materials.emplace_back();
    scene_.background = {color(1.0), color(1.0)};
    scene_.ambient = color(0.3);
    scene_.attenuation.mode = static_cast<AttenuationMode>(pick(3));
    scene_.attenuation.k = coin() ? 1.0 : 4.0 * unit();
  }

  Paint paint() {
    if (pick(4) > 0) return color(1.0);
    const Color a = color(1.0), b = color(1.0);
    return Checker{a, b, between(0.3, 2.0)};
  }

  void add_material() {
    Material m;
    m.diffuse = paint();
    m.ambient = coin() ? m.diffuse : paint();
    if (coin()) m.specular = color(1.0);
    m.shininess = pick(4) == 0 ? 1e4 * unit() : 100.0 * unit();
    if (coin()) m.reflection = color(0.8);
    if (coin()) m.transmission = color(0.8);
    m.ior = coin() ? 1.5 : between(0.5, 2.5);
    m.priority = pick(3);
    m.fresnel = coin();
    scene_.materials.push_back(m);
  }
  MaterialId material() { return static_cast<MaterialId>(pick(static_cast<int>(scene_.materials.size()))); }

  // A tetrahedron, a closed cube, and triangles at random, with normals of every length.
  void add_meshes() {
    MeshData tetra;
    tetra.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    tetra.indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    tetra.crease_deg = 180.0 * unit();
    MeshData cube;
    for (int i = 0; i < 8; ++i) cube.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2 & 1);
    cube.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                    2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    cube.crease_deg = 180.0 * unit();
    MeshData any;
    const int vertices = 3 + pick(4), triangles = 1 + pick(5);
    for (int i = 0; i < vertices; ++i) any.positions.push_back(point(2.0));
    for (int i = 0; i < 3 * triangles; ++i) any.indices.push_back(static_cast<uint32_t>(pick(vertices)));
    if (coin())
      for (int i = 0; i < vertices; ++i) any.normals.push_back(point(1.0));
    scene_.meshes = {std::move(tetra), std::move(cube), std::move(any)};
  }

  void add_light() {
    Light light;
    light.kind = static_cast<LightKind>(pick(2));
    if (light.kind == LightKind::point)
      light.position = point(6.0);
    else
      light.direction = direction();
    light.color = color(1.0);
    light.intensity = between(0.0, 5.0);
    light.shadow = coin();
    scene_.lights.push_back(light);
  }

  // The first object is no mesh: one of flat triangles alone would leave nothing to see, which the language refuses.
  Shape shape() {
    switch (pick(scene_.objects.empty() ? 4 : 6)) {
      case 0: {
        const Vec3 center = point(3.0);
        return SphereShape{center, size()};
      }
      case 1: {
        const Vec3 corner = point(3.0);
        const double x = pick(6) == 0 ? 0.0 : size(), y = size();
        return BoxShape{corner, corner + Vec3(x, y, size())};
      }
      case 2: {
        const Vec3 at = point(3.0);
        return PlaneShape{at, direction()};
      }
      case 3:
        return ChessPieceShape{static_cast<Piece>(pick(kPieceKinds)), static_cast<Side>(pick(2)), point(2.0), 8};
      default:
        return MeshShape{static_cast<uint32_t>(pick(3))};
    }
  }

  // Turned by quarters or anyhow, stretched or mirrored, moved.
  Mat4 transform() {
    if (coin()) return Mat4(1.0);
    const Vec3 axis = glm::normalize(direction());
    const double half_angle = coin() ? 0.25 * 3.14159265358979 * pick(8) : between(0.0, 3.2);
    Mat3 m = glm::mat3_cast(glm::dquat(std::cos(half_angle), std::sin(half_angle) * axis));
    for (int k = 0; k < 3; ++k) m[k] *= (coin() ? 1.0 : size()) * (pick(8) == 0 ? -1.0 : 1.0);
    Mat4 world(m);
    world[3] = Vec4(point(2.0), 1.0);
    return world;
  }

  void add_object() {
    Object object;
    object.shape = shape();
    object.material = material();
    object.world_from_shape = transform();
    scene_.objects.push_back(std::move(object));
  }

  View make_view() {
    View view;
    view.render.shadows = coin();
    view.render.max_depth = pick(5);
    view.render.ray_budget = 1 + pick(64);
    view.render.weight_cutoff = coin() ? 0.002 : 0.2 * unit();
    view.render.seed = bytes_.ConsumeIntegral<uint8_t>();
    Camera camera;
    camera.projection = static_cast<Projection>(pick(2));
    camera.position = point(coin() ? 8.0 : 2.0);
    camera.target = point(1.0);
    if (camera.target == camera.position) camera.target.x += 1.0;
    camera.up = direction();
    camera.fov_y_deg = coin() ? 40.0 : between(1.0, 170.0);
    camera.height = between(0.5, 9.0);
    view.camera = camera;
    return view;
  }

  FuzzedDataProvider bytes_;
  Scene scene_;
};

std::string text(const Vec3& v) {
  std::ostringstream out;
  out << std::setprecision(17) << "[" << v.x << ", " << v.y << ", " << v.z << "]";
  return out.str();
}

void tell(std::ostream& out, const Shape& shape) {
  if (const auto* sphere = std::get_if<SphereShape>(&shape))
    out << "sphere " << text(sphere->center) << " " << sphere->radius;
  if (const auto* box = std::get_if<BoxShape>(&shape)) out << "box " << text(box->min) << " " << text(box->max);
  if (const auto* plane = std::get_if<PlaneShape>(&shape))
    out << "plane " << text(plane->point) << " " << text(plane->normal);
  if (const auto* mesh = std::get_if<MeshShape>(&shape)) out << "mesh " << mesh->mesh;
  if (const auto* piece = std::get_if<ChessPieceShape>(&shape))
    out << "piece " << static_cast<int>(piece->piece) << " " << text(piece->position);
}

}  // namespace

std::string told(const SceneAndView& made) {
  std::ostringstream out;
  out << std::setprecision(17);
  const Camera& camera = *made.view.camera;
  out << (camera.projection == Projection::perspective ? "perspective " : "orthographic ") << text(camera.position)
      << " to " << text(camera.target) << " up " << text(camera.up) << " fov " << camera.fov_y_deg << " height "
      << camera.height << " depth " << made.view.render.max_depth << " budget " << made.view.render.ray_budget
      << " cutoff " << made.view.render.weight_cutoff << " shadows " << made.view.render.shadows << " seed "
      << made.view.render.seed << "\n";
  for (const Object& object : made.scene.objects) {
    tell(out, object.shape);
    out << " material " << object.material;
    if (object.world_from_shape != Mat4(1.0))
      for (int column = 0; column < 4; ++column) out << " " << text(Vec3(object.world_from_shape[column]));
    out << "\n";
  }
  for (const Material& m : made.scene.materials)
    out << "material kr " << text(m.reflection) << " kt " << text(m.transmission) << " ior " << m.ior << " priority "
        << m.priority << " fresnel " << m.fresnel << " n " << m.shininess << "\n";
  const MeshData& any = made.scene.meshes[2];
  out << "mesh 2:";
  for (const Vec3& p : any.positions) out << " " << text(p);
  for (const uint32_t i : any.indices) out << " " << i;
  for (const Vec3& n : any.normals) out << " n" << text(n);
  for (const Light& light : made.scene.lights)
    out << "\nlight " << static_cast<int>(light.kind) << " " << text(light.position) << text(light.direction) << " "
        << light.intensity << " shadow " << light.shadow;
  return out.str();
}

SceneAndView scene_from_bytes(const uint8_t* data, size_t size) { return Maker(data, size).make(); }

}  // namespace tilelight::fuzz
