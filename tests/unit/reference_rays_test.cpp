// SPDX-License-Identifier: Apache-2.0
// The reference renderer's mirrors, glass and media against closed forms.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/reference_scenes.h"

namespace tilelight {
namespace {

using namespace reference_test;  // NOLINT(google-build-using-namespace)

std::vector<uint32_t> bodies_hit(const Look& seen) {
  std::vector<uint32_t> ids;
  for (const ReferenceRay& ray : seen.rays)
    if (ray.hit_id != kNothingHit) ids.push_back(static_cast<uint32_t>(ray.hit_id >> 32));
  return ids;
}

double sine_to_z(const Vec3& direction) { return std::sqrt(1.0 - direction.z * direction.z); }

TEST(ReferenceMirrors, SumTheGeometricSeries) {
  for (const double kr : {0.5, 0.9, 0.99}) {
    for (const int depth : {0, 5, 50, 1000}) {
      Scene scene = dark_scene();
      scene.ambient = Color(1.0);
      Material mirror = glowing(Color(0.3));
      mirror.reflection = Color(kr);
      const MaterialId id = add_material(scene, mirror);
      add_object(scene, PlaneShape{Vec3(0, 0, 1), Vec3(0, 0, 1)}, id);
      add_object(scene, PlaneShape{Vec3(0, 0, -1), Vec3(0, 0, 1)}, id);
      View view = square_view(1);
      view.render.max_depth = depth;
      const Look seen = look(ReferenceScene(scene), Vec3(0), Vec3(0, 0, 1), view);
      const double expected = 0.3 * (1.0 - std::pow(kr, depth + 1)) / (1.0 - kr);
      EXPECT_NEAR(seen.pixel.color.x / expected, 1.0, 1e-12);
      EXPECT_NEAR(seen.pixel.untraced.x, std::pow(kr, depth + 1), 1e-12);
    }
  }
}

TEST(ReferenceMirrors, TurnARayByTwiceTheAngle) {
  Scene scene = dark_scene();
  add_object(scene, PlaneShape{Vec3(0), Vec3(0.3, 1.0, -0.2)}, add_material(scene, clear(Color(1.0), Color(0.0))));
  const Look seen = look(ReferenceScene(scene), Vec3(1, 5, 2), Vec3(0.2, -1, 0.1));
  const Vec3 n = glm::normalize(Vec3(0.3, 1.0, -0.2)), d = glm::normalize(Vec3(0.2, -1, 0.1));
  ASSERT_EQ(seen.rays.size(), 2u);
  EXPECT_NEAR(glm::dot(seen.rays[1].direction, n), -glm::dot(d, n), 1e-15);
  EXPECT_LT(glm::length(glm::cross(seen.rays[1].direction, n) - glm::cross(d, n)), 1e-15);
}

TEST(ReferenceWeights, StopAPathBelowTheCutoffAndSayHowMuchWasLeft) {
  Scene scene = dark_scene();
  const MaterialId id = add_material(scene, clear(Color(0.5, 0.25, 0.1), Color(0.0)));
  add_object(scene, PlaneShape{Vec3(0, 0, 1), Vec3(0, 0, 1)}, id);
  add_object(scene, PlaneShape{Vec3(0, 0, -1), Vec3(0, 0, 1)}, id);
  View view = square_view(1);
  view.render.weight_cutoff = 0.0625;  // 0.5^4: followed, as it is not under the cut-off
  const Look seen = look(ReferenceScene(scene), Vec3(0), Vec3(0, 0, 1), view);
  EXPECT_EQ(seen.rays.size(), 5u);
  EXPECT_EQ(seen.pixel.untraced.x, 0.03125);
}

TEST(ReferenceWeights, KeepATreeOfMirrorsAndGlassWithinItsBudget) {
  Scene scene = dark_scene();
  const MaterialId id = add_material(scene, clear(Color(0.5), Color(0.5)));
  Uniform uniform(10);
  for (int i = 0; i < 20; ++i) add_object(scene, SphereShape{2.0 * uniform.direction(), 0.8}, id);
  View view = square_view(1);
  view.render.max_depth = 50;
  view.render.ray_budget = 1000;
  const Look seen = look(ReferenceScene(scene), Vec3(0, 0, 9), Vec3(0.05, 0, -1), view);
  EXPECT_EQ(seen.rays.size(), 1001u);
  EXPECT_TRUE(std::is_sorted(seen.rays.begin(), seen.rays.end(),
                             [](const ReferenceRay& a, const ReferenceRay& b) { return a.depth < b.depth; }));
}

TEST(ReferenceGlass, LosesNoLightInAWhiteFurnace) {
  Scene scene = dark_scene();
  scene.background = {Color(1.0), Color(1.0)};
  Material glass = clear(Color(0.25), Color(0.75));
  add_object(scene, SphereShape{}, add_material(scene, glass));
  glass.fresnel = true;
  glass.reflection = Color(1.0), glass.transmission = Color(1.0);
  add_object(scene, SphereShape{Vec3(0.5, 2, 0), 0.9}, add_material(scene, glass));
  const ReferenceScene furnace(scene);
  View view = square_view(1);
  view.render.max_depth = 12;
  Uniform uniform(11);
  for (int i = 0; i < 200; ++i) {
    const Vec3 from = Vec3(0, 1, 0) + 7.0 * uniform.direction(), target(0.0, uniform.between(-1, 2.5), 0.0);
    const ReferencePixel pixel = look(furnace, from, target - from, view).pixel;
    ASSERT_NEAR(pixel.color.x + pixel.untraced.x, 1.0, 1e-14);
  }
}

TEST(ReferenceGlass, OfTheIndexOfAirIsNotThere) {
  Scene scene = dark_scene();
  scene.background = {Color(0.25), Color(0.75)};
  scene.meshes.push_back(box_mesh(Vec3(0.4)));
  const MaterialId air = add_material(scene, clear(Color(0.0), Color(1.0), 1.0));
  add_object(scene, SphereShape{}, air);
  add_object(scene, MeshShape{0}, air);
  const ReferenceScene nothing(scene);
  Uniform uniform(12);
  for (int i = 0; i < 200; ++i) {
    const Vec3 from = 5.0 * uniform.direction(), d = glm::normalize(uniform.direction() - from);
    ASSERT_NEAR(look(nothing, from, d).pixel.color.x, 0.25 + 0.25 * (1.0 + d.y), 1e-15);
  }
}

TEST(ReferenceGlass, ReflectsTotallyFromTheCriticalAngleOn) {
  Scene scene = dark_scene();
  add_object(scene, BoxShape{Vec3(-9), Vec3(9)}, add_material(scene, clear(Color(0.0), Color(1.0))));
  const ReferenceScene block(scene);
  const auto second = [&](double angle) {
    return look(block, Vec3(0), Vec3(std::sin(angle), 0, std::cos(angle))).rays[1].kind;
  };
  const double critical = 0.7297276562269663;  // asin(1 / 1.5)
  EXPECT_EQ(second(critical - 1e-9), ReferenceRayKind::refracted);
  EXPECT_EQ(second(critical + 1e-9), ReferenceRayKind::reflected);
}

TEST(ReferenceGlass, ShiftsARayThroughParallelPlatesAndLeavesItsDirection) {
  const double n = 1.5, thickness = 0.01;
  Scene scene = dark_scene();
  const MaterialId glass = add_material(scene, clear(Color(0.0), Color(1.0), n));
  for (int i = 0; i < 100; ++i) add_object(scene, BoxShape{Vec3(-9, -9, i), Vec3(9, 9, i + thickness)}, glass);
  View view = square_view(1);
  view.render.max_depth = 1000;
  const double theta = 0.05;
  const Vec3 from(-5, 0.3, -1), d(std::sin(theta), 0, std::cos(theta));
  const Look seen = look(ReferenceScene(scene), from, d, view);
  ASSERT_EQ(seen.rays.size(), 201u);
  const ReferenceRay& last = seen.rays.back();
  EXPECT_LT(glm::length(last.direction - d), 1e-14);
  const double shift = glm::length(glm::cross(last.origin - from, d));
  const double s = std::sin(theta),
               expected = 100.0 * thickness * s * (1.0 - std::cos(theta) / std::sqrt(n * n - s * s));
  EXPECT_NEAR(shift, expected, 1e-13);
}

TEST(ReferenceGlass, FocusesLikeABallLens) {
  Scene scene = dark_scene();
  add_object(scene, SphereShape{}, add_material(scene, clear(Color(0.0), Color(1.0), 1.5)));
  const Look seen = look(ReferenceScene(scene), Vec3(1e-5, 0, 5), Vec3(0, 0, -1));
  const ReferenceRay& out = seen.rays.back();
  // Paraxial focus of a ball of index n and radius 1 lies at n / (2 (n - 1)) behind its centre.
  const double z = out.origin.z - out.origin.x / out.direction.x * out.direction.z;
  EXPECT_NEAR(z, -1.5, 1e-8);
}

TEST(ReferenceGlass, PassesStraightThroughThinSheets) {
  Scene scene = dark_scene();
  scene.background = {Color(1.0), Color(1.0)};
  const MaterialId glass = add_material(scene, clear(Color(0.0), Color(0.5)));
  add_object(scene, PlaneShape{Vec3(0), Vec3(0, 1, 0.4)}, glass);
  add_object(scene, BoxShape{Vec3(-9, -2, -9), Vec3(9, -2, 9)}, glass);
  MeshData open = box_mesh(Vec3(5.0));
  open.indices.resize(open.indices.size() - 3);
  scene.meshes.push_back(open);
  add_object(scene, MeshShape{0}, glass);
  const Look seen = look(ReferenceScene(scene), Vec3(1, 10, 1.5), Vec3(0.1, -1, 0.05));
  EXPECT_EQ(bodies_hit(seen), (std::vector<uint32_t>{2, 0, 1, 2}));
  for (const ReferenceRay& ray : seen.rays) EXPECT_EQ(ray.direction, seen.rays[0].direction);
  EXPECT_EQ(seen.pixel.color.x, 1.0 / 16.0);
}

TEST(ReferenceFresnel, GivesTheTextbookReflectanceAtNormalIncidenceAndAtBrewstersAngle) {
  Scene scene = dark_scene();
  Material glass = clear(Color(0.9), Color(0.8));
  glass.fresnel = true;
  add_object(scene, BoxShape{Vec3(-9), Vec3(9)}, add_material(scene, glass));
  const ReferenceScene block(scene);
  const auto weights = [&](double theta) {
    View view = square_view(1);
    view.render.max_depth = 1;
    return look(block, Vec3(0.5 - 2.0 * std::tan(theta), 0.5, 11), Vec3(std::sin(theta), 0, -std::cos(theta)), view)
        .rays;
  };
  const double normal = 0.04;  // ((1.5 - 1) / (1.5 + 1))^2
  EXPECT_NEAR(weights(0.0)[1].weight.x, 0.9 * normal, 1e-15);
  EXPECT_NEAR(weights(0.0)[2].weight.x, 0.8 * (1.0 - normal), 1e-15);
  const double s = (1.5 * 1.5 - 1.0) / (1.5 * 1.5 + 1.0);  // at Brewster's angle only this polarisation is reflected
  EXPECT_NEAR(weights(std::atan(1.5))[1].weight.x, 0.9 * 0.5 * s * s, 1e-15);
}

// Two plates that overlap: z in [0, 2] of index 1.5 and z in [1, 3] of index 1.33.
Look through_overlap(int first_priority, int second_priority) {
  Scene scene = dark_scene();
  Material glass = clear(Color(0.0), Color(1.0), 1.5), water = clear(Color(0.0), Color(1.0), 1.33);
  glass.priority = first_priority, water.priority = second_priority;
  add_object(scene, BoxShape{Vec3(-9, -9, 0), Vec3(9, 9, 2)}, add_material(scene, glass));
  add_object(scene, BoxShape{Vec3(-9, -9, 1), Vec3(9, 9, 3)}, add_material(scene, water));
  return look(ReferenceScene(scene), Vec3(0, 0, -1), Vec3(0.6, 0, 0.8));
}

TEST(ReferenceMedia, GiveTheOverlapToTheHigherPriority) {
  const Look water_wins = through_overlap(0, 1);  // interfaces at z = 0, 1, 3
  ASSERT_EQ(bodies_hit(water_wins), (std::vector<uint32_t>{0, 1, 1}));
  EXPECT_NEAR(sine_to_z(water_wins.rays[1].direction), 0.6 / 1.5, 1e-14);
  EXPECT_NEAR(sine_to_z(water_wins.rays[2].direction), 0.6 / 1.33, 1e-14);
  EXPECT_NEAR(sine_to_z(water_wins.rays[3].direction), 0.6, 1e-14);
  EXPECT_NEAR(water_wins.rays[3].origin.z, 3.0, 1e-15);

  const Look glass_wins = through_overlap(1, 0);  // at z = 0, 2, 3
  ASSERT_EQ(bodies_hit(glass_wins), (std::vector<uint32_t>{0, 0, 1}));
  EXPECT_NEAR(glass_wins.rays[2].origin.z, 2.0, 1e-15);
  EXPECT_NEAR(sine_to_z(glass_wins.rays[2].direction), 0.6 / 1.33, 1e-14);
  EXPECT_NEAR(glass_wins.rays[3].origin.z, 3.0, 1e-15);
  EXPECT_NEAR(sine_to_z(glass_wins.rays[3].direction), 0.6, 1e-14);
}

TEST(ReferenceMedia, OfEqualPriorityAreWhereTheRayEnteredLast) {
  const Look seen = through_overlap(0, 0);  // at z = 0, 1, 3: the end of the glass lies inside the water
  ASSERT_EQ(bodies_hit(seen), (std::vector<uint32_t>{0, 1, 1}));
  EXPECT_NEAR(sine_to_z(seen.rays[2].direction), 0.6 / 1.33, 1e-14);
  EXPECT_NEAR(sine_to_z(seen.rays[3].direction), 0.6, 1e-14);
}

TEST(ReferenceMedia, MakeAThinShellOfFourInterfaces) {
  Scene scene = dark_scene();
  add_object(scene, SphereShape{Vec3(0), 1.0}, add_material(scene, clear(Color(0.0), Color(1.0), 1.5)));
  add_object(scene, SphereShape{Vec3(0), 1.0 - 1e-6}, add_material(scene, clear(Color(0.0), Color(1.0), 1.0)));
  const ReferenceScene shell(scene);
  Uniform uniform(13);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 offset(uniform.between(-0.6, 0.6), uniform.between(-0.6, 0.6), 5.0);
    const Look seen = look(shell, offset, Vec3(0, 0, -1));
    ASSERT_EQ(bodies_hit(seen), (std::vector<uint32_t>{0, 1, 1, 0}));
    ASSERT_LT(glm::length(seen.rays.back().direction - Vec3(0, 0, -1)), 1e-5);
  }
}

TEST(ReferenceMedia, AreKnownToAnEyeInside) {
  Scene scene = dark_scene();
  const MaterialId glass = add_material(scene, clear(Color(0.0), Color(1.0), 1.5));
  const MaterialId water = add_material(scene, clear(Color(0.0), Color(1.0), 1.33));
  scene.meshes.push_back(box_mesh(Vec3(2.0)));
  add_object(scene, SphereShape{Vec3(0), 1.0}, water);  // inside the block though it comes first
  add_object(scene, MeshShape{0}, glass);
  add_object(scene, SphereShape{Vec3(9, 0, 0), 1.0}, glass);
  const ReferenceScene block(scene);
  EXPECT_EQ(block.media_around(Vec3(0.1, 0.2, 0)), (std::vector<uint32_t>{1, 0}));
  EXPECT_EQ(block.media_around(Vec3(1.5, 1.5, 0)), (std::vector<uint32_t>{1}));
  EXPECT_TRUE(block.media_around(Vec3(3, 0, 0)).empty());
  const Look seen = look(block, Vec3(0, 0, 0), Vec3(0.4, 0, 0.9));  // from the centre: unbent into the glass
  EXPECT_LT(glm::length(seen.rays[1].direction - seen.rays[0].direction), 1e-14);
  EXPECT_NEAR(sine_to_z(seen.rays[2].direction), 1.5 * sine_to_z(seen.rays[0].direction), 1e-13);
}

// Two cubes of edge 2 in one mesh, the second moved along x.
TEST(ReferenceMedia, AreAroundAnEyeAsOftenAsTheShellsOfAMeshOverlapThere) {
  const auto scene_of = [](double moved) {
    Scene scene = dark_scene();
    MeshData two = box_mesh(Vec3(1.0));
    const MeshData one = two;
    for (const Vec3& p : one.positions) two.positions.push_back(p + Vec3(moved, 0, 0));
    for (const uint32_t i : one.indices) two.indices.push_back(i + static_cast<uint32_t>(one.positions.size()));
    scene.meshes.push_back(two);
    add_object(scene, MeshShape{0}, add_material(scene, clear(Color(0.0), Color(1.0), 1.5)));
    return ReferenceScene(scene);
  };
  using Ids = std::vector<uint32_t>;
  const ReferenceScene overlapping = scene_of(0.5), touching = scene_of(2.0);
  EXPECT_EQ(overlapping.media_around(Vec3(0.2, 0.1, 0)), (Ids{0, 0}));
  EXPECT_EQ(overlapping.media_around(Vec3(-0.8, 0.1, 0)), Ids{0});
  EXPECT_EQ(overlapping.media_around(Vec3(1.3, 0.1, 0)), Ids{0});
  EXPECT_EQ(overlapping.media_around(Vec3(1.6, 0.1, 0)), Ids{});
  const Vec3 x(1, 0, 0), at(0.2, 0.1, 0.3);
  EXPECT_EQ(reference::exit_distances(overlapping.body(0), at, x).size(), 2u);
  EXPECT_NEAR(reference::exit_distances(overlapping.body(0), at, x)[0], 1.3, 1e-15);
  EXPECT_NEAR(reference::exit_distances(overlapping.body(0), at, x)[1], 0.8, 1e-15);
  ASSERT_EQ(reference::exit_distances(touching.body(0), at, x).size(), 1u);
  EXPECT_NEAR(reference::exit_distances(touching.body(0), at, x)[0], 2.8, 1e-15) << "through both";
}

TEST(ReferenceMedia, OfABubbleInGlassBendAsGlassInAirTurnedAround) {
  const auto sine_inside = [](double outer, double inner) {
    Scene scene = dark_scene();
    add_object(scene, BoxShape{Vec3(-9), Vec3(9)}, add_material(scene, clear(Color(0.0), Color(1.0), outer)));
    add_object(scene, SphereShape{}, add_material(scene, clear(Color(0.0), Color(1.0), inner)));
    return look(ReferenceScene(scene), Vec3(0.3, 0, 5), Vec3(0, 0, -1)).rays[1].direction;
  };
  EXPECT_LT(glm::length(sine_inside(1.5, 1.0) - sine_inside(1.0, 1.0 / 1.5)), 1e-15);
}

}  // namespace
}  // namespace tilelight
