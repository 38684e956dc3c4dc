// SPDX-License-Identifier: Apache-2.0
// Where the reference renderer's rays hit, against closed forms; and the forms that older texts print, failing.
#include <gtest/gtest.h>

#include "tests/unit/reference_scenes.h"

namespace tilelight {
namespace {

using namespace reference_test;  // NOLINT(google-build-using-namespace)

ReferenceScene one_sphere(const Vec3& center, double radius) {
  Scene scene = dark_scene();
  add_object(scene, SphereShape{center, radius});
  return ReferenceScene(scene);
}

TEST(ReferenceSphere, CoversTheAreaOfItsSilhouetteInPerspective) {
  for (const double distance : {10.0, 1e4, 1e6}) {
    const double tan_half = 2.56 / distance;
    const auto camera = perspective_camera(Vec3(0, 0, distance), Vec3(0), tan_half);
    const double expected = kPi / (distance * distance - 1.0) / (4.0 * tan_half * tan_half);
    EXPECT_NEAR(mean_of_view(one_sphere(Vec3(0), 1.0), camera, 256).coverage / expected, 1.0, 2e-3) << distance;
  }
}

TEST(ReferenceSphere, CoversADiscInOrthographicProjection) {
  const auto scene = one_sphere(Vec3(1, 2, 3), 1.0);
  const Mean mean = mean_of_view(scene, ortho_camera(Vec3(9, 2, 3), Vec3(1, 2, 3), 4.0), 256);
  EXPECT_NEAR(mean.coverage, kPi / 16.0, 1e-3);
}

TEST(ReferenceSphere, SurroundsAnEyeAtItsCentreAtDistanceOne) {
  const auto scene = one_sphere(Vec3(5, 6, 7), 1.0);
  Uniform uniform(1);
  for (int i = 0; i < 1000; ++i) {
    const Look seen = look(scene, Vec3(5, 6, 7), uniform.direction());
    ASSERT_TRUE(seen.hits());
    ASSERT_NEAR(glm::length(seen.hit_point() - Vec3(5, 6, 7)), 1.0, 1e-14);
  }
}

TEST(ReferenceSphere, IsAPlanetUnderAnEyeOfAStandingMan) {
  const double r = 6.371e6, h = 1.7;
  const Vec3 zenith = glm::normalize(Vec3(0.3, 0.8, 0.4)), north = glm::normalize(glm::cross(zenith, Vec3(1, 0, 0)));
  const auto scene = one_sphere(Vec3(0), r);
  const Vec3 eye = (r + h) * zenith;
  EXPECT_NEAR(glm::length(look(scene, eye, -zenith).hit_point() - eye), h, 1e-6 * h);
  double sky = 0.0, ground = 0.01;  // dip below the horizontal, rad
  for (int i = 0; i < 60; ++i) {
    const double dip = 0.5 * (sky + ground);
    (look(scene, eye, std::cos(dip) * north - std::sin(dip) * zenith).hits() ? ground : sky) = dip;
  }
  EXPECT_NEAR(ground, std::sqrt(2.0 * h / r), 1e-6);
}

TEST(ReferenceSphere, IsHitOnlyByRaysThatPassWithinItsRadius) {
  const auto scene = one_sphere(Vec3(0), 1.0);
  for (const double inside : {1e-6, 1e-9, 1e-12}) {
    EXPECT_TRUE(look(scene, Vec3(1.0 - inside, 0, 7), Vec3(0, 0, -1)).hits()) << inside;
    EXPECT_FALSE(look(scene, Vec3(1.0 + inside, 0, 7), Vec3(0, 0, -1)).hits()) << inside;
  }
}

TEST(ReferenceSphere, BecomesAnEllipsoidUnderItsTransform) {
  Scene scene = dark_scene();
  add_object(scene, SphereShape{}).world_from_shape = Mat4(Mat3(3, 0, 0, 1, 2, 0, 0, 0, 0.5));  // scaled and sheared
  const Mat3 local_from_world = glm::inverse(Mat3(3, 0, 0, 1, 2, 0, 0, 0, 0.5));
  const ReferenceScene ellipsoid(scene);
  Uniform uniform(2);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 from = 9.0 * uniform.direction();
    const Look seen = look(ellipsoid, from, -from + uniform.direction());
    if (!seen.hits()) continue;
    ASSERT_NEAR(glm::length(local_from_world * seen.hit_point()), 1.0, 1e-14);
  }
}

// The quadratic for |o + t u| = 1 as some books print it. The right root is 4.5.
TEST(TextbookForms, GiveAWrongDistanceWhereTheDirectionIsNotOfUnitLength) {
  const double right =
      glm::length(look(one_sphere(Vec3(0), 0.5), Vec3(0, 0, 5), Vec3(0, 0, -1)).hit_point() - Vec3(0, 0, 5));
  EXPECT_DOUBLE_EQ(right, 4.5);
  const Vec3 o(0, 0, 10), u(0, 0, -2);  // the same ray in the frame of the unit sphere
  const double a = glm::dot(u, u), b = 2.0 * glm::dot(o, u), c = glm::dot(o, o) - 1.0;
  EXPECT_DOUBLE_EQ((-b - std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a), right);
  const double with_a_taken_as_one = (-b - std::sqrt(b * b - 4.0 * c)) / 2.0;
  EXPECT_GT(std::fabs(with_a_taken_as_one - right), 1.0);
  const double with_a_squared = -c / (a * a + b);  // A^2 t + B t + C = 0 is not even quadratic
  EXPECT_GT(std::fabs(with_a_squared - right), 0.3);
}

TEST(TextbookForms, LoseTheSphereAroundTheEyeByTakingTheSmallerRootBeforeItsSign) {
  const double smaller_root = -1.0, larger_root = 1.0;  // for any ray from the centre of the unit sphere
  const auto textbook_hits = [&] { return std::min(smaller_root, larger_root) > 0.0; };
  EXPECT_FALSE(textbook_hits());
  EXPECT_TRUE(look(one_sphere(Vec3(0), 1.0), Vec3(0), Vec3(0, 0, 1)).hits());
}

TEST(ReferenceBox, ShowsAllSixFacesToAnEyeInside) {
  Scene scene = dark_scene();
  scene.ambient = Color(0.25);
  add_object(scene, BoxShape{Vec3(-1, -2, -3), Vec3(1, 2, 3)}, add_material(scene, glowing(Color(0.5, 0.7, 0.9))));
  add_point_light(scene, Vec3(10, 10, 10));  // outside: nothing in here is lit
  const ReferenceScene box(scene);
  for (const Vec3& d : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
    for (const double sign : {-1.0, 1.0}) {
      const Look seen = look(box, Vec3(0.1, 0.2, 0.3), sign * d);
      EXPECT_NEAR(glm::dot(seen.hit_point(), sign * d), glm::dot(Vec3(1, 2, 3), d), 1e-15);
      EXPECT_EQ(seen.pixel.color, Color(0.25) * Color(0.5, 0.7, 0.9));
    }
  }
}

TEST(ReferenceBox, IsMetByRaysInThePlaneOfItsFace) {
  Scene scene = dark_scene();
  add_object(scene, BoxShape{Vec3(-1), Vec3(1)});
  const ReferenceScene box(scene);
  for (const double zero : {0.0, -0.0}) {
    EXPECT_TRUE(look(box, Vec3(1, 0.3, 5), Vec3(zero, zero, -1)).hits());
    EXPECT_TRUE(look(box, Vec3(-1, -1, 5), Vec3(zero, zero, -1)).hits());
    EXPECT_FALSE(look(box, Vec3(1.0 + 1e-12, 0.3, 5), Vec3(zero, zero, -1)).hits());
  }
}

TEST(ReferenceBox, IsSeenWhenItIsFlat) {
  Scene scene = dark_scene();
  add_object(scene, BoxShape{Vec3(-1, 0.5, -1), Vec3(1, 0.5, 1)});
  const ReferenceScene flat(scene);
  EXPECT_EQ(look(flat, Vec3(0.2, 3, 0.1), Vec3(0, -1, 0)).hit_point(), Vec3(0.2, 0.5, 0.1));
  EXPECT_EQ(look(flat, Vec3(0.2, -3, 0.1), Vec3(0, 1, 0)).hit_point(), Vec3(0.2, 0.5, 0.1));
}

TEST(ReferenceMesh, AgreesWithTheBoxThatItCopies) {
  const Vec3 half(0.5, 1.0, 0.25);
  Mat4 turned = Mat4(glm::mat3_cast(glm::normalize(glm::dquat(0.9, 0.1, -0.3, 0.2))));
  turned[3] = Vec4(1, -2, 0.5, 1);
  Scene boxes = dark_scene(), meshes = dark_scene();
  add_object(boxes, BoxShape{-half, half}).world_from_shape = turned;
  meshes.meshes.push_back(box_mesh(half));
  add_object(meshes, MeshShape{0}).world_from_shape = turned;
  const ReferenceScene box(boxes), mesh(meshes);
  Uniform uniform(3);
  int hits = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 from = Vec3(1, -2, 0.5) + 5.0 * uniform.direction();
    const Vec3 d = Vec3(1, -2, 0.5) + 1.2 * uniform.direction() - from;
    const Look a = look(box, from, d), b = look(mesh, from, d);
    ASSERT_EQ(a.hits(), b.hits());
    if (!a.hits()) continue;
    ++hits;
    ASSERT_LT(glm::length(a.hit_point() - b.hit_point()), 1e-13);
  }
  EXPECT_GT(hits, 1000);
}

TEST(ReferenceMesh, LetsNoRaySlipThroughItsEdgesAndVertices) {
  Scene scene = dark_scene();
  scene.meshes.push_back(box_mesh(Vec3(1.0)));
  add_object(scene, MeshShape{0}).world_from_shape = Mat4(glm::mat3_cast(glm::dquat(0.5, 0.5, -0.5, 0.5)));
  const ReferenceScene mesh(scene);
  Uniform uniform(4);
  for (int i = 0; i < 20000; ++i) {
    Vec3 corner(0.0);
    for (int k = 0; k < 3; ++k) corner[k] = uniform() < 0.5 ? -1.0 : 1.0;
    if (i % 2) corner[i % 3] = uniform.between(-1.0, 1.0);  // a point of an edge, else a vertex
    const Vec3 from = Vec3(uniform.between(-0.9, 0.9), uniform.between(-0.9, 0.9), uniform.between(-0.9, 0.9));
    ASSERT_TRUE(look(mesh, from, corner - from).hits());
  }
}

TEST(ReferenceTies, GoToTheLowestBodyThoughItsNumbersRoundOtherwise) {
  Mat4 turned = Mat4(glm::mat3_cast(glm::normalize(glm::dquat(0.9, 0.13, -0.31, 0.27))));
  Mat4 again = turned;
  again[3] = turned * Vec4(0.1, 0, 0.2, 1);  // moved within the plane of its top
  Scene scene = dark_scene();
  add_object(scene, BoxShape{Vec3(-1, -0.3, -1), Vec3(1, 0.7, 1)}).world_from_shape = again;
  add_object(scene, BoxShape{Vec3(-1, 0.1, -1), Vec3(1, 0.7, 1)}).world_from_shape = turned;
  const ReferenceScene both(scene);
  Uniform uniform(5);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 target = transform_point(turned, Vec3(uniform.between(-0.8, 0.9), 0.7, uniform.between(-0.7, 0.9)));
    const Vec3 from = transform_point(turned, Vec3(uniform.between(-9, 9), uniform.between(1, 5), 0.4));
    ASSERT_EQ(look(both, from, target - from).pixel.primary_id, surface_id(0, 3));
  }
}

TEST(ReferenceCamera, SeesTheSceneUprightWithItsRightOnTheRight) {
  Scene scene = dark_scene();
  add_object(scene, SphereShape{Vec3(1, 0, 0), 0.2});
  add_object(scene, SphereShape{Vec3(0, 1, 0), 0.2});
  const ReferenceScene spheres(scene);
  View view = square_view(100);
  view.image.width = 200;
  for (const Camera& camera :
       {ortho_camera(Vec3(0, 0, 5), Vec3(0), 4.0), perspective_camera(Vec3(0, 0, 5), Vec3(0), 0.4)}) {
    const ReferenceEye eye = make_reference_eye(spheres, view, camera);
    EXPECT_EQ(reference_sample(spheres, eye, Vec2(125, 50)).primary_id, surface_id(0, 0));
    EXPECT_EQ(reference_sample(spheres, eye, Vec2(100, 25)).primary_id, surface_id(1, 0));
    EXPECT_EQ(reference_sample(spheres, eye, Vec2(75, 50)).primary_id, kNothingHit);
  }
}

TEST(ReferenceCamera, HasNorthUpInAViewStraightDown) {
  Scene scene = dark_scene();
  add_object(scene, SphereShape{Vec3(0), 0.1});
  const ReferenceScene sphere(scene);
  Camera camera = perspective_camera(Vec3(0, 5, 0), Vec3(0), 0.4);
  const ReferenceEye eye = make_reference_eye(sphere, square_view(10), camera);
  EXPECT_NEAR(glm::length(eye.right), glm::length(eye.down), 1e-15);
  EXPECT_NEAR(glm::dot(glm::normalize(eye.down), Vec3(0, 0, 1)), 1.0, 1e-15);  // -z is up
}

}  // namespace
}  // namespace tilelight
