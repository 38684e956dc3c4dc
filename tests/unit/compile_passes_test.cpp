// SPDX-License-Identifier: Apache-2.0
// The passes of compile_scene: what they keep, what they leave out, and that they change nothing that is seen.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "renderer/compile/compile.h"
#include "renderer/compile/compiled_mesh.h"
#include "renderer/compile/normalise.h"
#include "renderer/compile/passes.h"

namespace tilelight {
namespace {

Material painted(const char* name, double grey) {
  Material m;
  m.name = name;
  m.ambient = m.diffuse = Color(grey);
  return m;
}

Object sphere_at(const Vec3& center, double radius, MaterialId material = 0) {
  Object object;
  object.shape = SphereShape{center, radius};
  object.material = material;
  return object;
}

Light sun(double intensity) {
  Light light;
  light.kind = LightKind::directional;
  light.intensity = intensity;
  return light;
}

Scene one_sphere() {
  Scene scene;
  scene.materials = {painted("", 0.8)};
  scene.objects = {sphere_at({0, 1, 0}, 1)};
  scene.lights = {sun(1.0)};
  return scene;
}

bool says(const std::vector<LeftOut>& list, const std::string& what) {
  return std::any_of(list.begin(), list.end(),
                     [&](const LeftOut& item) { return item.what == what && !item.why.empty(); });
}

const LeftOutList& left_out_of(const CompiledScene& scene) { return scene_plan(scene).left_out; }

class Compile : public testing::Test {
 protected:
  TilePool pool_{2};
};

TEST_F(Compile, DropsMaterialsThatNoObjectWears) {
  Scene scene = one_sphere();
  scene.materials.push_back(painted("unworn", 0.5));
  const auto compiled = compile_scene(scene, pool_);
  EXPECT_EQ(compiled->materials.size(), 1u);
  EXPECT_TRUE(says(left_out_of(*compiled), "material unworn"));
}

TEST_F(Compile, DropsBlackLightsAndAllLightsWhereNothingReflects) {
  Scene scene = one_sphere();
  scene.lights.push_back(sun(0.0));
  auto compiled = compile_scene(scene, pool_);
  EXPECT_EQ(compiled->lights.size(), 1u);
  EXPECT_TRUE(says(left_out_of(*compiled), "light lights/1"));

  scene.materials[0].diffuse = Color(0.0);
  compiled = compile_scene(scene, pool_);
  EXPECT_TRUE(compiled->lights.empty());
}

TEST_F(Compile, EachFeatureOfASceneFlipsExactlyItsBit) {
  const FeatureSet base = scene_plan(*compile_scene(one_sphere(), pool_)).features;
  const auto flipped_by = [&](const std::function<void(Scene&)>& change) {
    Scene scene = one_sphere();
    change(scene);
    return scene_plan(*compile_scene(scene, pool_)).features.bits() ^ base.bits();
  };
  const auto bit = [](Feature f) { return 1u << static_cast<uint32_t>(f); };
  EXPECT_EQ(flipped_by([](Scene& s) { s.materials[0].reflection = Color(0.5); }), bit(Feature::reflection));
  EXPECT_EQ(flipped_by([](Scene& s) { s.materials[0].specular = Color(0.5); }), bit(Feature::specular));
  EXPECT_EQ(flipped_by([](Scene& s) { s.materials[0].diffuse = Checker{}; }), bit(Feature::checker));
  EXPECT_EQ(flipped_by([](Scene& s) { s.lights[0].shadow = false; }), bit(Feature::shadows));
  EXPECT_EQ(flipped_by([](Scene& s) { s.materials[0].transmission = Color(0.5); }),
            bit(Feature::transmission) | bit(Feature::tinted_shadows));  // light falls through glass by definition
  EXPECT_EQ(flipped_by([](Scene& s) {
              Object plane;
              plane.shape = PlaneShape{};
              s.objects.push_back(plane);
            }),
            bit(Feature::planes));
}

TEST_F(Compile, AViewWithoutShadowsOrDepthNeedsALeanerKernel) {
  Scene scene = one_sphere();
  scene.materials[0].reflection = Color(0.5);
  scene.objects.push_back(sphere_at({3, 1, 0}, 1));
  const auto compiled = compile_scene(scene, pool_);
  View view;
  EXPECT_EQ(plan_view(*compiled, view, "").variant, KernelVariant::mirrors_shadows);
  view.render.max_depth = 0;
  EXPECT_EQ(plan_view(*compiled, view, "").variant, KernelVariant::local_shadows);
  view.render.shadows = false;
  EXPECT_EQ(plan_view(*compiled, view, "").variant, KernelVariant::local);
  EXPECT_TRUE(says(plan_view(*compiled, view, "").plan.left_out, "feature shadows"));
}

TEST_F(Compile, OneConvexBodySeenFromOutsideNeedsNoShadowRays) {
  const auto has_shadows = [&](const Scene& scene, const View& view) {
    return plan_view(*compile_scene(scene, pool_), view, "").features.has(Feature::shadows);
  };
  Scene scene = one_sphere();
  View outside, inside;
  outside.camera = Camera{.position = {0, 1, 5}, .target = {0, 1, 0}};
  inside.camera = Camera{.position = {0, 1, 0.9}, .target = {0, 1, 0}};
  EXPECT_FALSE(has_shadows(scene, outside));
  EXPECT_TRUE(has_shadows(scene, inside));
  scene.materials[0].transmission = Color(0.5);
  EXPECT_TRUE(has_shadows(scene, outside));
  scene = one_sphere();
  scene.objects[0].shape = BoxShape{{-1, 0, -1}, {1, 2, 1}};
  EXPECT_FALSE(has_shadows(scene, outside));
  EXPECT_TRUE(has_shadows(scene, inside));
  scene.objects[0].shape = PlaneShape{{0, 0, 0}, {0, 1, 0}};
  EXPECT_FALSE(has_shadows(scene, outside));
  scene.objects.push_back(sphere_at({3, 1, 0}, 1));
  EXPECT_TRUE(has_shadows(scene, outside));
}

TEST_F(Compile, NormalisesTheSceneIntoTheUnitCubeByAPowerOfTwo) {
  Scene scene = one_sphere();
  scene.objects = {sphere_at({1e7 + 3, -7e6, 3e6}, 5), sphere_at({1e7 - 9, -7e6, 3e6}, 1)};
  const auto compiled = compile_scene(scene, pool_);
  EXPECT_EQ(compiled->units, 16.0);  // half the longest side is 9
  for (const CompiledBody& body : compiled->bodies) {
    const Box box = body_bounds(body);
    EXPECT_GE(std::min({box.lo.x, box.lo.y, box.lo.z}), -1.0);
    EXPECT_LE(std::max({box.hi.x, box.hi.y, box.hi.z}), 1.0);
  }
}

TEST_F(Compile, InstancesOfAMeshShareItsGeometry) {
  Scene scene = one_sphere();
  Object rook;
  rook.shape = ChessPieceShape{Piece::rook, Side::white, {0, 0, 0}, 16};
  scene.objects = {rook, rook, rook};
  const auto compiled = compile_scene(scene, pool_);
  EXPECT_EQ(compiled->meshes.size(), 1u);
  EXPECT_EQ(scene_plan(*compiled).triangles_instanced, 3 * scene_plan(*compiled).triangles_stored);
}

TEST_F(Compile, WarnsOfGlassWithoutAnInside) {
  Scene scene = one_sphere();
  scene.materials[0].transmission = Color(0.9);
  const auto with_mesh = [&](std::vector<uint32_t> indices) {
    MeshData tetrahedron;
    tetrahedron.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    tetrahedron.indices = std::move(indices);
    scene.meshes = {tetrahedron};
    scene.objects.resize(1);
    scene.objects.emplace_back().shape = MeshShape{0};
    return compile_scene(scene, pool_);
  };
  EXPECT_TRUE(scene_plan(*with_mesh({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3})).warnings.empty());
  const auto warnings = scene_plan(*with_mesh({0, 2, 1, 0, 1, 3, 0, 3, 2})).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].pointer, "/objects/1");
  EXPECT_EQ(warnings[0].code, "open_glass");
  const auto inside_out = with_mesh({1, 2, 0, 3, 1, 0, 2, 3, 0, 3, 2, 1});
  ASSERT_EQ(scene_plan(*inside_out).warnings.size(), 1u);
  EXPECT_EQ(scene_plan(*inside_out).warnings[0].pointer, "/objects/1");
  EXPECT_EQ(scene_plan(*inside_out).warnings[0].code, "inside_out_glass");
  const auto sheet = with_mesh({0, 1, 2, 0, 2, 1});
  ASSERT_EQ(scene_plan(*sheet).warnings.size(), 1u);
  EXPECT_EQ(scene_plan(*sheet).warnings[0].code, "open_glass");
  EXPECT_EQ(sheet->media, 1u) << "the sphere alone";
  scene.materials[0].transmission = Color(0.0);
  EXPECT_TRUE(scene_plan(*with_mesh({1, 2, 0, 3, 1, 0, 2, 3, 0, 3, 2, 1})).warnings.empty()) << "seen from both sides";
}

TEST_F(Compile, AsksForNeighboursWhereMediaMayTouchAlone) {
  Scene scene;
  scene.materials.resize(2);
  scene.materials[0].transmission = Color(0.9);
  const auto touching = [&](const std::vector<std::pair<Shape, MaterialId>>& shapes) {
    scene.objects.clear();
    for (const auto& [shape, material] : shapes) {
      Object& object = scene.objects.emplace_back();
      object.shape = shape, object.material = material;
    }
    const auto compiled = compile_scene(scene, pool_);
    std::vector<bool> out(shapes.size());
    for (const CompiledBody& body : compiled->bodies) out[body.body] = body.may_touch_media;
    return out;
  };
  using Flags = std::vector<bool>;
  const BoxShape low{{0, 0, 0}, {1, 1, 1}}, high{{0, 1, 0}, {1, 2, 1}}, apart{{0, 1.01, 0}, {1, 2, 1}};
  EXPECT_EQ(touching({{low, 0}, {high, 0}}), (Flags{true, true}));
  EXPECT_EQ(touching({{low, 0}, {apart, 0}}), (Flags{false, false}));
  EXPECT_EQ(touching({{low, 0}, {high, 1}, {PlaneShape{}, 0}}), (Flags{false, false, false})) << "ranks will do";
  const SphereShape ball{{5, 0, 0}, 1.0}, inner{{5, 0, 0}, 0.9}, next{{7, 0, 0}, 1.0}, across{{6, 0, 0}, 1.0};
  EXPECT_EQ(touching({{ball, 0}, {inner, 0}}), (Flags{false, false}));
  EXPECT_EQ(touching({{ball, 0}, {across, 0}}), (Flags{false, false}));
  EXPECT_EQ(touching({{ball, 0}, {next, 0}}), (Flags{true, true}));
  EXPECT_EQ(touching({{ball, 0}, {ball, 0}}), (Flags{true, true}));
}

TEST_F(Compile, RanksSurfacesInOnePlaceByWhatTheyAreAndNotByTheirOrder) {
  Scene scene;
  scene.materials.resize(5);
  for (const int glass : {0, 1, 2, 3}) scene.materials[glass].transmission = Color(0.5 + 0.1 * glass);
  scene.materials[0].ior = 1.3;
  scene.materials[2].priority = 1;
  const BoxShape block{{0, 0, 0}, {1, 1, 1}};
  const std::vector<std::pair<Shape, MaterialId>> shapes = {
      {PlaneShape{}, 3}, {block, 4}, {block, 2}, {block, 1}, {block, 0}};
  std::vector<size_t> order = {0, 1, 2, 3, 4};
  do {
    scene.objects.clear();
    for (const size_t i : order) {
      scene.objects.emplace_back().shape = shapes[i].first;
      scene.objects.back().material = shapes[i].second;
    }
    const std::vector<Body> bodies = make_bodies(scene);
    for (size_t i = 0; i < order.size(); ++i) EXPECT_EQ(bodies[i].rank, order[i]);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_F(Compile, TheFramedCameraHoldsTheBoundingSphereInBothDirections) {
  const auto compiled = compile_scene(one_sphere(), pool_);
  for (const auto& [width, height] : {std::pair{1280, 720}, {300, 900}}) {
    const Camera camera = framed_camera(*compiled, width, height);
    const double distance = glm::length(camera.position - Vec3(0, 1, 0));
    const double half_y = glm::radians(camera.fov_y_deg / 2);
    const double half_x = std::atan(std::tan(half_y) * width / height);
    EXPECT_NEAR(std::asin(1.05 / distance), std::min(half_x, half_y), 1e-9) << width << "x" << height;
    const Vec3 away = (camera.position - camera.target) / distance;
    EXPECT_NEAR(away.y, std::sin(glm::radians(25.0)), 1e-12);
    EXPECT_NEAR(std::atan2(away.x, away.z), glm::radians(30.0), 1e-12);
  }
}

TEST_F(Compile, FramesBodiesThatAreTooSmallForWhereTheyStand) {
  Scene scene = one_sphere();
  scene.objects = {sphere_at({1e30, -1e30, 1e30}, 1e-30)};
  const auto compiled = compile_scene(scene, pool_);
  const Camera camera = framed_camera(*compiled, 16, 9);
  EXPECT_NE(camera.position, camera.target);
  const ViewPlan plan = plan_view(*compiled, View{}, "SCALAR");
  EXPECT_NEAR(glm::length(plan.eye.forward), 1.0, 1e-12);
}

TEST_F(Compile, KeepsBodiesFiniteThatAreTooSmallForTheirScene) {
  Scene scene = one_sphere();
  scene.objects = {sphere_at({0, 0, 0}, 1e-320), sphere_at({1e30, 0, 0}, 1e30), sphere_at({0, 0, 0}, 1e-30)};
  scene.objects[2].world_from_shape[1] *= 1e-320;
  const auto expect_finite = [&] {
    const auto compiled = compile_scene(scene, pool_);
    for (const CompiledBody& body : compiled->bodies) {
      for (const Mat4& m : {body.world_from_local, body.local_from_world}) {
        for (int column = 0; column < 4; ++column) {
          for (int row = 0; row < 4; ++row) EXPECT_TRUE(std::isfinite(m[column][row])) << body.body;
        }
      }
      EXPECT_GT(glm::length(body.world_from_normal[0]), 0.0);
    }
  };
  expect_finite();
  scene.objects = {sphere_at({0, 0, 0}, 1e-320)};  // beside a plane, whose axes have the scene's unit
  scene.objects.emplace_back().shape = PlaneShape{};
  expect_finite();
  scene.objects = {sphere_at({0, 0, 0}, 1e-320)};  // alone, with a light far away
  scene.lights[0].kind = LightKind::point;
  scene.lights[0].position = Vec3(1e30, 0, 0);
  const auto alone = compile_scene(scene, pool_);
  EXPECT_TRUE(std::isfinite(glm::length(alone->lights[0].position)));
}

TEST_F(Compile, TheRadianceBoundIsTheSumOfTheGeometricSeries) {
  Scene scene = one_sphere();
  scene.background = {Color(0.0), Color(0.0)};
  scene.ambient = Color(0.5);
  scene.materials[0].reflection = Color(0.5);
  EXPECT_NEAR(compile_scene(scene, pool_)->radiance_bound, (0.5 * 0.8 + 1.0 * 0.8) / (1 - 0.5), 1e-12);
  scene.materials[0].reflection = Color(1.0);
  EXPECT_LT(compile_scene(scene, pool_)->radiance_bound, 0.0);  // none is finite
}

TEST_F(Compile, TellsHowFarTheNumbersOfASceneLieApart) {
  Scene scene = one_sphere();
  scene.objects = {sphere_at({1000, 0, 0}, 2.0), sphere_at({1000, 3, 0}, 0.002)};
  scene.materials[0].shininess = 5e4;
  scene.lights = {sun(6.0), sun(0.25)};
  const Stiffness s = scene_plan(*compile_scene(scene, pool_)).stiffness;
  EXPECT_NEAR(s.extent, std::sqrt(16.0 + 5.002 * 5.002 + 16.0), 1e-5);  // x and z of the larger, y from -2 to 3.002
  EXPECT_NEAR(s.offset_ratio, std::sqrt(1e6 + 0.501 * 0.501) / s.extent, 1e-4);
  EXPECT_NEAR(s.size_ratio, 1000.0, 1e-3);
  EXPECT_EQ(s.shininess, 5e4);
  EXPECT_NEAR(s.intensity_ratio, 24.0, 1e-12);
}

TEST_F(Compile, AnUpVectorAlongTheViewIsToldInThePlanOfThatView) {
  const auto compiled = compile_scene(one_sphere(), pool_);
  View view;
  view.camera = Camera{};
  view.camera->position = {0, 5, 0};
  const auto warnings_of = [&] { return plan_view(*compiled, view, "").plan.warnings; };
  ASSERT_EQ(warnings_of().size(), 1u);
  EXPECT_EQ(warnings_of()[0].pointer, "/camera");
  EXPECT_EQ(warnings_of()[0].code, "up_parallel_to_view");
  EXPECT_NE(warnings_of()[0].detail.find("-z takes its place"), std::string::npos);
  view.camera->up = {1e-8, 1, 0};
  EXPECT_TRUE(warnings_of().empty());
}

// From 1e12 radii away the rounding of the eye is 1e-4; between two pixels' rays lies 1e-6 all the same.
TEST_F(Compile, RaysOfAFarEyeStartJustBeforeTheBodies) {
  Camera camera;
  camera.target = {0.1, 0.2, 0.3};
  const Vec3 back = glm::normalize(Vec3(1, 2, 3));
  camera.position = camera.target + 1e12 * back;
  camera.fov_y_deg = 2e-4 / 1e12 * 180.0 / 3.14159265358979323846;  // a picture of height 2e-4 at the target
  Eye eye = make_eye(camera, 200, 200, Vec3(0.0), 1.0);
  start_near_bodies(eye, camera.target, 200, 200, {});
  EXPECT_NEAR(glm::length(eye_ray(eye, 100, 100).origin), 2.0, 0.1);
  for (const double x : {0.0, 57.0, 199.0}) {
    const EyeRay ray = eye_ray(eye, x, 100.0), next = eye_ray(eye, x + 1.0, 100.0);
    EXPECT_NEAR(glm::length(next.origin - ray.origin), 1e-6, 1e-14);
    EXPECT_NEAR(glm::length(ray.direction + back), 0.0, 1e-14);
  }
  const Vec3 middle = eye_ray(eye, 100, 100).origin - camera.target;
  EXPECT_NEAR(glm::length(middle - glm::dot(middle, back) * back), 0.0, 1e-14);  // on the axis
}

TEST_F(Compile, RaysOfAFarEyeStartInItWhereAPlaneLiesBetween) {
  Scene scene = one_sphere();
  View view;
  view.image = {32, 32, 0.0};
  view.camera = Camera{};
  view.camera->position = {0, 5e4, 1e5};
  view.camera->fov_y_deg = 1e-3;
  const auto is_at_eye = [&] {
    const Eye eye = plan_view(*compile_scene(scene, pool_), view, "").eye;
    return eye.start == eye.origin;
  };
  EXPECT_FALSE(is_at_eye());
  Object plane;
  plane.shape = PlaneShape{Vec3(0, -1, 0), Vec3(0, 1, 0)};
  scene.objects.push_back(plane);
  EXPECT_FALSE(is_at_eye());  // the plane lies behind the bodies
  scene.objects.back().shape = PlaneShape{Vec3(0, 1e4, 0), Vec3(0, 1, 0)};
  EXPECT_TRUE(is_at_eye());
}

// Moving by whole numbers below 2^53 is exact, so nothing may change, not even the part of a mesh's place that comes
// from its own middle.
TEST_F(Compile, AMeshFarFromTheOriginKeepsItsPlaceAmongTheOthers) {
  const auto compiled = [&](const Vec3& by) {
    Scene scene = one_sphere();
    scene.objects = {sphere_at(by, 4.0)};
    MeshData mesh;
    mesh.positions = {Vec3(0, 0, 0), Vec3(0.3, 0, 0), Vec3(0, 0.7, 0), Vec3(0, 0, 0.9)};
    mesh.indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    scene.meshes = {mesh};
    Object object;
    object.shape = MeshShape{0};
    object.world_from_shape[3] = Vec4(by, 1.0);
    scene.objects.push_back(object);
    return compile_scene(scene, pool_)->bodies[1].world_from_local;
  };
  EXPECT_EQ(compiled(Vec3(0.0)), compiled(Vec3(0x1p50, -0x1p51, 0x1p49)));
}

// What turns and grows about its own middle stays there, however far that is and however much it grows.
TEST_F(Compile, ABodyThatIsScaledAboutItsMiddleKeepsIt) {
  const Vec3 middle(1e15, 1e15 / 3.0, -1e15 / 7.0);
  Scene scene = one_sphere();
  Object object = sphere_at(middle, 1.0);
  object.pivot = middle;
  object.world_from_shape = Mat4(Mat3(0.0, 0.0, -1e15, 0.0, 1e15, 0.0, 1e15, 0.0, 0.0));
  object.world_from_shape[3] = Vec4(middle, 1.0);
  scene.objects = {object};
  object.shape = BoxShape{middle - 1.0, middle + 1.0};
  scene.objects.push_back(object);
  object.shape = PlaneShape{middle, Vec3(0, 1, 0)};
  scene.objects.push_back(object);
  for (const Body& body : make_bodies(scene)) EXPECT_EQ(Vec3(body.world_from_local[3]), middle);
}

TEST_F(Compile, TheLengthsOfDirectionsSayNothingHoweverSmall) {
  Scene scene = one_sphere();
  scene.lights[0].direction = {0, -1e-200, 0};
  Object plane;
  plane.shape = PlaneShape{Vec3(0.0), Vec3(0, 1e-200, 0)};
  scene.objects.push_back(plane);
  const auto compiled = compile_scene(scene, pool_);
  EXPECT_EQ(compiled->lights[0].to_light, Vec3(0, 1, 0));
  EXPECT_EQ(Vec3(compiled->bodies[1].world_from_local[1]) * compiled->units, Vec3(0, 1, 0));
}

TEST_F(Compile, ASceneOfAnyUnitIsNormalisedToTheSameBits) {
  const auto compiled = [&](double s) {
    Scene scene = one_sphere();
    scene.objects = {sphere_at(s * Vec3(0.1, 0.9, 0.2), s * 0.7), sphere_at(s * Vec3(3, 2, 1), s * 0.4)};
    Object plane;
    plane.shape = PlaneShape{s * Vec3(0, -1, 0), Vec3(1, 5, 2)};
    scene.objects.push_back(plane);
    return compile_scene(scene, pool_);
  };
  const auto one = compiled(1.0);
  for (const double s : {0x1p-900, 0x1p-600, 0x1p90}) {
    const auto other = compiled(s);
    EXPECT_EQ(other->units, s * one->units);
    EXPECT_EQ(other->bounding_radius, s * one->bounding_radius);
    for (const size_t i : {0, 1}) EXPECT_EQ(other->bodies[i].world_from_local, one->bodies[i].world_from_local);
    EXPECT_EQ(other->bodies[2].world_from_normal, one->bodies[2].world_from_normal);
    const Vec3 above = transform_point(other->bodies[2].local_from_world, Vec3(0.1, 0.2, 0.3)) / s;
    EXPECT_EQ(above, transform_point(one->bodies[2].local_from_world, Vec3(0.1, 0.2, 0.3)));
  }
}

TEST_F(Compile, ABodyFarSmallerThanTheSceneHasAnInverse) {
  Scene scene = one_sphere();
  scene.objects.push_back(sphere_at({0, 1, 0}, 1e-80));
  const auto compiled = compile_scene(scene, pool_);
  const CompiledBody& mote = compiled->bodies[1];
  EXPECT_NEAR(mote.local_from_world[0][0] * 1e-80 / compiled->units, 1.0, 1e-15);
  EXPECT_EQ(transform_point(mote.local_from_world, Vec3(mote.world_from_local[3])), Vec3(0.0));
  EXPECT_NEAR(glm::length(mote.world_from_normal * Vec3(0, 1, 0)), 1.0, 1e-15);
}

}  // namespace
}  // namespace tilelight
