// SPDX-License-Identifier: Apache-2.0
// Scenes for tests of the reference renderer: black and empty until something is put in, so that every closed form
// stands alone.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "renderer/measure/reference.h"

namespace tilelight::reference_test {

inline constexpr double kPi = std::numbers::pi;

// No lights, no ambient light, black background, no attenuation.
inline Scene dark_scene() {
  Scene scene;
  scene.materials.emplace_back();
  scene.background = {Color(0.0), Color(0.0)};
  scene.ambient = Color(0.0);
  scene.attenuation = {AttenuationMode::none, 0.0};
  return scene;
}

inline MaterialId add_material(Scene& scene, const Material& material) {
  scene.materials.push_back(material);
  return static_cast<MaterialId>(scene.materials.size() - 1);
}

inline Object& add_object(Scene& scene, Shape shape, MaterialId material = 0) {
  Object object;
  object.shape = std::move(shape);
  object.material = material;
  return scene.objects.emplace_back(std::move(object));
}

inline Light& add_point_light(Scene& scene, const Vec3& position, double intensity = 1.0) {
  Light light;
  light.position = position;
  light.intensity = intensity;
  return scene.lights.emplace_back(light);
}

inline Light& add_directional_light(Scene& scene, const Vec3& direction, double intensity = 1.0) {
  Light light;
  light.kind = LightKind::directional;
  light.direction = direction;
  light.intensity = intensity;
  return scene.lights.emplace_back(light);
}

// Gives off the colour by itself (under ambient light 1) and reflects no light.
inline Material glowing(const Color& color) {
  Material material;
  material.ambient = color;
  material.diffuse = Color(0.0);
  return material;
}

inline Material matte(const Color& kd) {
  Material material;
  material.ambient = Color(0.0);
  material.diffuse = kd;
  return material;
}

inline Material clear(const Color& kr, const Color& kt, double ior = 1.5) {
  Material material = glowing(Color(0.0));
  material.reflection = kr;
  material.transmission = kt;
  material.ior = ior;
  return material;
}

// A square image, so that image_point (x, y) in [0, size] covers the field.
inline View square_view(int size) {
  View view;
  view.image = {size, size, 0.0};
  view.render.weight_cutoff = 0.0;
  return view;
}

inline Camera ortho_camera(const Vec3& position, const Vec3& target, double height) {
  Camera camera;
  camera.projection = Projection::orthographic;
  camera.position = position;
  camera.target = target;
  camera.height = height;
  return camera;
}

inline Camera perspective_camera(const Vec3& position, const Vec3& target, double tan_half_fov) {
  Camera camera;
  camera.position = position;
  camera.target = target;
  camera.fov_y_deg = 2.0 * std::atan(tan_half_fov) * 180.0 / kPi;
  return camera;
}

// One ray from a point in a direction.
struct Look {
  ReferencePixel pixel;
  std::vector<ReferenceRay> rays;
  const Vec3& hit_point() const { return rays.front().hit_point; }
  bool hits() const { return pixel.primary_id != kNothingHit; }
};
inline Look look(const ReferenceScene& scene, const Vec3& from, const Vec3& direction,
                 const View& view = square_view(1)) {
  Camera camera;
  camera.position = from;
  camera.target = from + direction;
  Look seen;
  const Vec2 middle(0.5 * view.image.width, 0.5 * view.image.height);
  seen.pixel = reference_sample(scene, make_reference_eye(scene, view, camera), middle, &seen.rays);
  return seen;
}

// The mean colour over size x size points in the middle of the pixels, and the part of them that hit something.
struct Mean {
  Color color{0.0};
  double coverage = 0.0;
};
inline Mean mean_of_view(const ReferenceScene& scene, const Camera& camera, int size) {
  const ReferenceEye eye = make_reference_eye(scene, square_view(size), camera);
  Mean mean;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const ReferencePixel pixel = reference_sample(scene, eye, Vec2(x + 0.5, y + 0.5));
      mean.color += pixel.color;
      if (pixel.primary_id != kNothingHit) mean.coverage += 1.0;
    }
  }
  mean.color /= static_cast<double>(size) * size;
  mean.coverage /= static_cast<double>(size) * size;
  return mean;
}

// The 12 triangles of the box from -half to half, outward.
inline MeshData box_mesh(const Vec3& half) {
  MeshData mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.push_back(half * Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
  mesh.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                  2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return mesh;
}

// A generator of its own, so that tests see the same numbers everywhere: uniform in [0, 1).
class Uniform {
 public:
  explicit Uniform(uint64_t seed) : state_(seed) {}
  double operator()() {
    state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<double>(state_ >> 11) * 0x1p-53;
  }
  double between(double a, double b) { return a + (b - a) * (*this)(); }
  Vec3 direction() {
    const double z = between(-1.0, 1.0), phi = between(0.0, 2.0 * kPi), r = std::sqrt(1.0 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }

 private:
  uint64_t state_;
};

}  // namespace tilelight::reference_test
