// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/agreement_scenes.h"

#include <cmath>
#include <utility>

#include "tests/unit/reference_scenes.h"

namespace tilelight::agreement {
namespace {

using reference_test::add_object;
using reference_test::box_mesh;
using reference_test::Uniform;

class SceneMaker {
 public:
  explicit SceneMaker(uint64_t seed) : uniform_(mix(seed)) {}

  RandomScene make(int size_px) {
    make_surroundings();
    make_materials();
    make_meshes();
    make_objects();
    const int lights = pick(5);
    for (int i = 0; i < lights; ++i) add_light();
    return {std::move(scene_), make_view(size_px)};
  }

 private:
  static uint64_t mix(uint64_t seed) { return (seed + 1) * 0x9E3779B97F4A7C15ull; }

  double between(double a, double b) { return uniform_.between(a, b); }
  int pick(int count) { return static_cast<int>(uniform_() * count); }
  bool chance(double p) { return uniform_() < p; }
  Vec3 point(double reach) { return {between(-reach, reach), between(-reach, reach), between(-reach, reach)}; }
  Color color(double low, double high) { return {between(low, high), between(low, high), between(low, high)}; }

  void make_surroundings() {
    scene_.materials.emplace_back();
    scene_.background = {color(0.0, 0.6), color(0.2, 1.0)};
    scene_.ambient = color(0.0, 0.3);
    const AttenuationMode modes[] = {AttenuationMode::linear, AttenuationMode::inverse_square, AttenuationMode::none};
    scene_.attenuation = {modes[pick(3)], chance(0.2) ? 0.0 : between(0.0, 6.0)};
  }

  Paint paint() {
    if (chance(0.75)) return color(0.1, 0.9);
    return Checker{color(0.5, 1.0), color(0.0, 0.5), between(0.3, 1.5)};
  }

  void make_materials() {
    for (int i = 0; i < 5; ++i) {
      Material m;
      m.diffuse = paint();
      m.ambient = chance(0.7) ? m.diffuse : paint();
      if (chance(0.6)) m.specular = color(0.1, 0.9);
      m.shininess = chance(0.1) ? 0.0 : 400.0 * std::pow(uniform_(), 3.0);
      if (chance(0.4)) m.reflection = color(0.05, 0.5);
      if (chance(0.35)) m.transmission = color(0.2, 0.5);
      m.ior = chance(0.15) ? between(0.6, 1.0) : between(1.0, 2.0);
      m.priority = chance(0.5) ? 0 : pick(3);
      m.fresnel = chance(0.4);
      scene_.materials.push_back(m);
    }
  }

  MaterialId material() { return static_cast<MaterialId>(1 + pick(static_cast<int>(scene_.materials.size()) - 1)); }

  // A ball of latitudes and longitudes; closed, or open at its pole.
  MeshData ball(int slices, int stacks, bool is_closed) {
    MeshData mesh;
    mesh.crease_deg = chance(0.5) ? 60.0 : 10.0;
    mesh.positions = {Vec3(0, 1, 0), Vec3(0, -1, 0)};
    const auto at = [&](int stack, int slice) { return static_cast<uint32_t>(2 + stack * slices + slice % slices); };
    for (int stack = 0; stack + 1 < stacks; ++stack) {
      for (int slice = 0; slice < slices; ++slice) {
        const double theta = reference_test::kPi * (stack + 1) / stacks,
                     phi = 2.0 * reference_test::kPi * (slice + 0.137) / slices;
        mesh.positions.emplace_back(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi));
      }
    }
    const auto triangle = [&](uint32_t a, uint32_t b, uint32_t c) {
      mesh.indices.insert(mesh.indices.end(), {a, b, c});
    };
    for (int slice = 0; slice < slices; ++slice) {
      if (is_closed) triangle(0, at(0, slice), at(0, slice + 1));
      triangle(1, at(stacks - 2, slice + 1), at(stacks - 2, slice));
      for (int stack = 0; stack + 2 < stacks; ++stack) {
        triangle(at(stack, slice), at(stack + 1, slice), at(stack + 1, slice + 1));
        triangle(at(stack, slice), at(stack + 1, slice + 1), at(stack, slice + 1));
      }
    }
    return mesh;
  }

  void make_meshes() {
    scene_.meshes.push_back(box_mesh(Vec3(0.8, 0.5, 0.6)));
    scene_.meshes.push_back(ball(5 + pick(12), 3 + pick(8), true));
    scene_.meshes.push_back(ball(5 + pick(12), 3 + pick(8), false));
  }

  // Turned about a random axis, sometimes stretched or mirrored, then moved.
  Mat4 placement(bool may_stretch) {
    const Vec3 axis = uniform_.direction();
    const double half_angle = between(0.0, reference_test::kPi);
    const glm::dquat turn(std::cos(half_angle), std::sin(half_angle) * axis);
    Vec3 scale(between(0.4, 1.4));
    if (may_stretch && chance(0.5)) scale = Vec3(between(0.3, 1.6), between(0.3, 1.6), between(0.3, 1.6));
    if (may_stretch && chance(0.15)) scale.x = -scale.x;
    Mat3 m = glm::mat3_cast(turn);
    for (int k = 0; k < 3; ++k) m[k] *= scale[k];
    Mat4 world(m);
    world[3] = Vec4(point(2.5), 1.0);
    return world;
  }

  void make_objects() {
    if (chance(0.6)) {
      const Vec3 normal = chance(0.5) ? Vec3(0, 1, 0) : Vec3(0, 1, 0) + 0.5 * uniform_.direction();
      add_object(scene_, PlaneShape{Vec3(0, between(-3.5, -2.0), 0), normal}, material());
    }
    const int count = 1 + pick(9);
    for (int i = 0; i < count; ++i) add_body();
  }

  void add_body() {
    switch (pick(6)) {
      case 0:
        add_object(scene_, SphereShape{point(2.5), between(0.3, 1.3)}, material());
        return;
      case 1:
        add_object(scene_, SphereShape{}, material()).world_from_shape = placement(true);
        return;
      case 2: {
        const Vec3 half(between(0.2, 1.0), chance(0.15) ? 0.0 : between(0.2, 1.0), between(0.2, 1.0));
        add_object(scene_, BoxShape{-half, half}, material()).world_from_shape = placement(true);
        return;
      }
      case 3: {
        const Vec3 corner = point(2.0);
        add_object(scene_, BoxShape{corner, corner + Vec3(between(0.3, 1.5), between(0.3, 1.5), between(0.3, 1.5))},
                   material());
        return;
      }
      case 4:
        add_object(scene_, MeshShape{static_cast<uint32_t>(pick(3))}, material()).world_from_shape = placement(true);
        return;
      case 5: {
        const ChessPieceShape piece{static_cast<Piece>(pick(kPieceKinds)), chance(0.5) ? Side::white : Side::black,
                                    Vec3(0.0, -0.8, 0.0), 8 + pick(8)};
        add_object(scene_, piece, material()).world_from_shape = placement(false);
        return;
      }
    }
  }

  void add_light() {
    Light light;
    light.color = color(0.4, 1.0);
    light.shadow = chance(0.8);
    if (chance(0.5)) {
      light.position = point(8.0) + Vec3(0, 4, 0);
      light.intensity = scene_.attenuation.mode == AttenuationMode::none ? between(0.2, 0.8) : between(2.0, 8.0);
    } else {
      light.kind = LightKind::directional;
      light.direction = uniform_.direction() - Vec3(0, 1, 0);
      light.intensity = between(0.1, 0.7);
    }
    scene_.lights.push_back(light);
  }

  View make_view(int size_px) {
    View view;
    view.image = {size_px, size_px, between(-1.0, 0.5)};
    view.render.shadows = chance(0.85);
    view.render.max_depth = pick(7);
    view.render.weight_cutoff = chance(0.7) ? 0.002 : 0.03;
    view.render.ray_budget = chance(0.9) ? 4096 : 1 + pick(12);
    view.render.seed = static_cast<uint32_t>(pick(1000));
    Camera camera;
    camera.position = 9.0 * uniform_.direction();
    if (camera.position.y < 0.0) camera.position.y = -camera.position.y;
    camera.target = point(0.8);
    camera.up = Vec3(0, 1, 0) + 0.2 * uniform_.direction();
    camera.fov_y_deg = between(20.0, 60.0);
    if (chance(0.25))
      camera.projection = Projection::orthographic, camera.height = between(4.0, 9.0);
    else if (chance(0.25))
      camera.position = point(2.0);  // among the bodies, maybe in one
    view.camera = camera;
    return view;
  }

  Uniform uniform_;
  Scene scene_;
};

}  // namespace

RandomScene make_random_scene(uint64_t seed, int size_px) { return SceneMaker(seed).make(size_px); }

}  // namespace tilelight::agreement
