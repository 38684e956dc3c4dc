// SPDX-License-Identifier: Apache-2.0
// Hits shaded side by side against the same hits one by one, on every instruction set.
#include <gtest/gtest.h>

#include <random>

#include "renderer/check/kit/meshes.h"
#include "renderer/check/kit/shots.h"
#include "renderer/compile/compile.h"
#include "renderer/shade/light_equation.h"
#include "renderer/shade/scatter.h"
#include "renderer/shade/surfaces.h"
#include "renderer/trace/eye_rays.h"
#include "renderer/trace/isa.h"

namespace tilelight {
namespace {

// Every kind of body, smooth and flat triangles, triangles whose edges' products vanish, checkers in two and three
// dimensions; highlights by products, by logarithms and none; both kinds of light, one on a surface.
Scene motley() {
  MeshData flat = check::icosphere(2);
  flat.normals.clear();
  MeshData tiny = check::icosphere(1);  // of some triangles the product of two edges vanishes
  for (size_t i = 0; i < tiny.positions.size(); i += 2) tiny.positions[i] *= 1e-110;
  Scene scene = check::scene_of_shapes({MeshShape{0}, MeshShape{1}, MeshShape{2}, SphereShape{{1.5, 0, 0}, 0.7},
                                        BoxShape{{-3, -1, -1}, {-1.2, 1, 1}}, PlaneShape{}});
  scene.meshes = {check::icosphere(3), flat, tiny};
  const Material plain = scene.materials[0];
  scene.materials.clear();
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    Material m = plain;
    m.diffuse = Checker{Color(0.9, 0.2, 0.1), Color(0.1, 0.8, 0.3), 0.13};
    m.specular = Color(i % 3 == 0 ? 0.0 : 0.5);
    m.shininess = std::array{3.0, 20.0, 17.5, 400.0, 0.0, 128.0}[i % 6];
    scene.materials.push_back(m);
    scene.objects[i].material = static_cast<MaterialId>(i);
  }
  Light lamp, sun;
  lamp.kind = LightKind::point, lamp.position = {2.0, 3.0, 1.5}, lamp.intensity = 7.0;
  sun.kind = LightKind::directional, sun.direction = {1.0, -2.0, 0.5};
  scene.lights = {lamp, sun};
  return scene;
}

class Surfaces : public testing::Test {
 protected:
  void SetUp() override {
    compiled_ = compile_scene(motley(), pool_);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    // What is shaded need not have been traced: so all bodies meet in one register.
    for (int i = 0; i < 6001; ++i) {  // one more than any register holds
      const Vec3 from(unit(random) * 2, unit(random) * 2, unit(random) * 2);
      const Vec3 to(unit(random), unit(random), unit(random));
      rays_.push_back({{from, glm::normalize(to - from), {}}});
      Hit hit;
      hit.t = 1.0 + unit(random);
      hit.body = static_cast<uint32_t>(random() % (compiled_->bodies.size() + 1));
      if (hit.body == compiled_->bodies.size()) hit = {};
      const BodyKind kind = hit.is_hit() ? compiled_->bodies[hit.body].kind : BodyKind::plane;
      if (kind == BodyKind::box) hit.prim = static_cast<uint32_t>(random() % 6);
      if (kind == BodyKind::mesh) {
        hit.prim = static_cast<uint32_t>(random() % compiled_->bodies[hit.body].mesh->triangles.size());
        hit.b0 = 0.5 + 0.5 * unit(random), hit.b1 = (1.0 - hit.b0) * (0.5 + 0.5 * unit(random));
      }
      hits_.push_back(hit);
    }
  }
  void TearDown() override { (void)select_isa("auto"); }

  TilePool pool_{2};
  std::shared_ptr<const CompiledScene> compiled_;
  std::vector<BoundedRay> rays_;
  std::vector<Hit> hits_;
};

TEST_F(Surfaces, AreThoseOfOneHitToTheLastBit) {
  std::vector<int64_t> met(compiled_->bodies.size());
  for (const std::string& isa : available_isas()) {
    ASSERT_TRUE(select_isa(isa).has_value());
    SurfaceColumns columns;
    make_surfaces(*compiled_, rays_, hits_, {}, columns);
    Column3 mirrored;
    mirror_surfaces(columns, rays_.size(), mirrored);
    int differing = 0;
    for (size_t i = 0; i < rays_.size(); ++i) {
      if (!hits_[i].is_hit()) continue;
      ++met[hits_[i].body];
      const Surface one = make_surface(*compiled_, rays_[i].ray, hits_[i]);
      const Surface column = surface_of(*compiled_, columns, hits_[i], i);
      differing += one.position != column.position || one.geometric_normal != column.geometric_normal ||
                   one.normal != column.normal || one.from_outside != column.from_outside ||
                   one.ambient != column.ambient || one.diffuse != column.diffuse ||
                   columns.is_lit_over_curve[i] != (one.body->mesh && !one.body->mesh->corner_normals.empty()) ||
                   mirror_direction(one, rays_[i].ray.direction) != mirrored[i];
    }
    EXPECT_EQ(differing, 0) << isa;
  }
  for (const int64_t hits : met) EXPECT_GT(hits, 1000);
}

TEST_F(Surfaces, AreLitAsOneHitIs) {
  for (const std::string& isa : available_isas()) {
    ASSERT_TRUE(select_isa(isa).has_value());
    SurfaceColumns columns;
    make_surfaces(*compiled_, rays_, hits_, {.smooth_terminator = false}, columns);
    int differing = 0, lit = 0;
    for (const CompiledLight& light : compiled_->lights) {
      LightColumns all;
      light_surfaces(*compiled_, light, columns, rays_.size(), true, all);
      for (size_t i = 0; i < rays_.size(); ++i) {
        if (!hits_[i].is_hit()) continue;
        const Surface surface = make_surface(*compiled_, rays_[i].ray, hits_[i]);
        const LightSample one = sample_light(*compiled_, light, surface, -rays_[i].ray.direction, false);
        lit += one.is_lit;
        differing += one.diffuse + one.specular != all.light[i] || one.to_light != all.to_light[i] ||
                     one.distance != all.distance[i];
      }
    }
    EXPECT_EQ(differing, 0) << isa;
    EXPECT_GT(lit, 3000) << isa;
  }
}

TEST_F(Surfaces, OfRoundedFacetsHaveTheCurveAboveThem) {
  SurfaceColumns columns;
  make_surfaces(*compiled_, rays_, hits_, {}, columns);
  int rounded = 0, lifted = 0;
  for (size_t i = 0; i < rays_.size(); ++i) {
    if (!hits_[i].is_hit()) continue;
    const Vec3 lift = columns.curve[i] - columns.position[i];
    rounded += columns.is_lit_over_curve[i];
    lifted += lift != Vec3(0.0);
    if (lift == Vec3(0.0)) continue;
    EXPECT_GT(glm::dot(lift, columns.geometric_normal[i]), 0.0);
  }
  EXPECT_GT(lifted, 100);
  EXPECT_LE(lifted, rounded);
}

TEST_F(Surfaces, AreSeenByTheRaysOfTheEye) {
  Camera camera;
  camera.position = {1.0, 2.0, 7.0};
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    camera.projection = projection;
    const Eye eye = make_eye(camera, 64, 48, Vec3(0.0), 1.0);
    ImagePoints points;
    for (int i = 0; i < 101; ++i) points.x.push_back(0.61 * i), points.y.push_back(0.37 * i);
    for (const std::string& isa : available_isas()) {
      ASSERT_TRUE(select_isa(isa).has_value());
      std::vector<BoundedRay> rays(points.size());
      aim_eye_rays(eye, points, rays);
      for (size_t i = 0; i < points.size(); ++i) {
        const EyeRay one = eye_ray(eye, points.x[i], points.y[i]);
        EXPECT_EQ(rays[i].ray.origin, one.origin) << isa;
        EXPECT_EQ(rays[i].ray.direction, one.direction) << isa;
      }
    }
  }
}

}  // namespace
}  // namespace tilelight
