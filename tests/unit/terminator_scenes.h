// SPDX-License-Identifier: Apache-2.0
// Smooth meshes and what stands close to them, for tests of where their light ends.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "renderer/check/kit/pictures.h"
#include "renderer/measure/reference.h"
#include "renderer/scene/scene.h"

namespace tilelight::terminator_test {

inline constexpr double kPi = std::numbers::pi;

inline void add_quad(MeshData& mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  for (const uint32_t i : {a, b, c, a, c, d}) mesh.indices.push_back(i);
}

// A closed drum of radius 1 along z, its first facet on top, level; smooth around.
inline MeshData drum(int sides, double half_length = 1.0) {
  MeshData mesh;
  const auto count = static_cast<uint32_t>(sides);
  for (int i = 0; i < sides; ++i) {
    const double angle = kPi / 2.0 + (2 * i - 1) * kPi / sides;
    for (const double z : {-half_length, half_length}) mesh.positions.emplace_back(std::cos(angle), std::sin(angle), z);
  }
  mesh.positions.emplace_back(0.0, 0.0, -half_length), mesh.positions.emplace_back(0.0, 0.0, half_length);
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t near = 2 * i, next = 2 * ((i + 1) % count);
    add_quad(mesh, near, next, next + 1, near + 1);
    for (const uint32_t k : {2 * count, next, near, 2 * count + 1, near + 1, next + 1}) mesh.indices.push_back(k);
  }
  mesh.crease_deg = 360.0 / sides + 1.0;
  return mesh;
}

// By its parallels and meridians, with the sphere's own normals; one of its facets looks up from (0, 1, 0) in the
// middle of its quad's longer triangle.
inline MeshData globe(int around) {
  MeshData mesh;
  const int rows = around / 2;
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column < around; ++column) {
      const double polar = kPi * row / rows, angle = 2.0 * kPi * column / around;
      mesh.positions.emplace_back(std::sin(polar) * std::cos(angle), std::cos(polar),
                                  std::sin(polar) * std::sin(angle));
    }
  }
  mesh.normals = mesh.positions;
  const auto at = [&](int row, int column) { return static_cast<uint32_t>(row * around + column % around); };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < around; ++column) {
      if (row > 0)
        for (const uint32_t i : {at(row, column), at(row, column + 1), at(row + 1, column + 1)})
          mesh.indices.push_back(i);
      if (row + 1 < rows)
        for (const uint32_t i : {at(row, column), at(row + 1, column + 1), at(row + 1, column)})
          mesh.indices.push_back(i);
    }
  }
  return mesh;
}

// Around y, with its own normals: round outside, a saddle within.
inline MeshData ring(int around, int across, double thickness = 0.4) {
  MeshData mesh;
  for (int i = 0; i < around; ++i) {
    for (int k = 0; k < across; ++k) {
      const double a = 2.0 * kPi * i / around, b = 2.0 * kPi * k / across;
      const Vec3 n(std::cos(b) * std::cos(a), std::sin(b), std::cos(b) * std::sin(a));
      mesh.normals.push_back(n);
      mesh.positions.push_back(Vec3(std::cos(a), 0.0, std::sin(a)) + thickness * n);
    }
  }
  const auto at = [&](int i, int k) { return static_cast<uint32_t>((i % around) * across + k % across); };
  for (int i = 0; i < around; ++i) {
    for (int k = 0; k < across; ++k) add_quad(mesh, at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k));
  }
  return mesh;
}

// Hills and hollows over a square of 3 by 3, smooth: open, or the top of a body with sides and a floor.
inline MeshData hills(int cuts, bool is_closed) {
  MeshData mesh;
  for (int row = 0; row <= cuts; ++row) {
    for (int column = 0; column <= cuts; ++column) {
      const double x = 3.0 * column / cuts - 1.5, z = 3.0 * row / cuts - 1.5;
      mesh.positions.emplace_back(x, 0.25 * std::sin(2.5 * x) * std::cos(2.5 * z), z);
    }
  }
  const auto at = [&](int row, int column) { return static_cast<uint32_t>(row * (cuts + 1) + column); };
  for (int row = 0; row < cuts; ++row) {
    for (int column = 0; column < cuts; ++column)
      add_quad(mesh, at(row, column + 1), at(row, column), at(row + 1, column), at(row + 1, column + 1));
  }
  mesh.crease_deg = 50.0;  // between any two facets of the hills, and any of them and a side
  if (!is_closed) return mesh;
  std::vector<uint32_t> rim;
  for (int i = 0; i < cuts; ++i) rim.push_back(at(0, i));
  for (int i = 0; i < cuts; ++i) rim.push_back(at(i, cuts));
  for (int i = cuts; i > 0; --i) rim.push_back(at(cuts, i));
  for (int i = cuts; i > 0; --i) rim.push_back(at(i, 0));
  const auto count = static_cast<uint32_t>(rim.size()), foot = static_cast<uint32_t>(mesh.positions.size());
  for (const uint32_t i : rim) mesh.positions.emplace_back(mesh.positions[i].x, -0.6, mesh.positions[i].z);
  mesh.positions.emplace_back(0.0, -0.6, 0.0);
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t next = (i + 1) % count;
    add_quad(mesh, rim[i], rim[next], foot + next, foot + i);
    for (const uint32_t k : {foot + i, foot + next, foot + count}) mesh.indices.push_back(k);
  }
  return mesh;
}

// A box as part of the mesh; its normals are its sides' unless the mesh gives normals.
inline void add_box(MeshData& mesh, const Vec3& min, const Vec3& max) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (int i = 0; i < 8; ++i)
    mesh.positions.emplace_back(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z);
  const auto side = [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    add_quad(mesh, first + a, first + b, first + c, first + d);
  };
  side(0, 4, 6, 2), side(1, 3, 7, 5), side(0, 1, 5, 4), side(2, 6, 7, 3), side(0, 2, 3, 1), side(4, 5, 7, 6);
}

// White matte bodies in the dark: what is seen of a surface is the cosine to its light.
inline Scene matte_scene() {
  Scene scene;
  Material matte;
  matte.ambient = Color(0.0), matte.diffuse = Color(1.0);
  scene.materials = {matte};
  scene.background = {Color(0.0), Color(0.0)};
  scene.ambient = Color(0.0);
  scene.attenuation = {AttenuationMode::none, 0.0};
  return scene;
}
inline Object& add(Scene& scene, Shape shape, MaterialId material = 0) {
  Object& object = scene.objects.emplace_back();
  object.shape = std::move(shape), object.material = material;
  return object;
}
inline Object& add(Scene& scene, const MeshData& mesh) {
  scene.meshes.push_back(mesh);
  return add(scene, MeshShape{static_cast<uint32_t>(scene.meshes.size() - 1)});
}
inline void add_sun(Scene& scene, const Vec3& to_light) {
  Light& light = scene.lights.emplace_back();
  light.kind = LightKind::directional, light.direction = -to_light;
}

// What an eye close to a place sees of it, straight on, by the kernels and by the reference.
struct Seen {
  double fast = 0.0, reference = 0.0;
};
inline Seen look_at(const Scene& scene, const Vec3& place, const Vec3& from, TilePool& pool,
                    const RenderSpec& render = {}) {
  ParsedScene parsed;
  parsed.scene = scene;
  Camera camera;
  camera.projection = Projection::orthographic;
  camera.position = from, camera.target = place, camera.height = 1e-9;
  const Vec3 way = glm::abs(glm::normalize(place - from));
  camera.up = way.y < 0.9 ? Vec3(0, 1, 0) : Vec3(0, 0, -1);
  parsed.view.camera = camera;
  parsed.view.image = {1, 1, 0.0};
  parsed.view.render = render;
  parsed.view.render.samples = 1;
  const ReferenceScene reference(scene);
  const ReferenceEye eye = make_reference_eye(reference, parsed.view, camera);
  return {check::picture_of(parsed, pool).linear[0], reference_sample(reference, eye, Vec2(0.5, 0.5)).color.x};
}

}  // namespace tilelight::terminator_test
