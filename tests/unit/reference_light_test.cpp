// SPDX-License-Identifier: Apache-2.0
// The reference renderer's light equation against closed forms.
#include <gtest/gtest.h>

#include "tests/unit/reference_scenes.h"

namespace tilelight {
namespace {

using namespace reference_test;  // NOLINT(google-build-using-namespace)

TEST(ReferenceLight, GivesTheDiscOfALambertSphereItsPhaseIntegral) {
  for (const double phase : {0.0, 0.5, kPi / 2.0, 2.5}) {
    Scene scene = dark_scene();
    add_object(scene, SphereShape{}, add_material(scene, matte(Color(1.0))));
    add_directional_light(scene, -Vec3(std::sin(phase), 0, std::cos(phase)));
    const Mean mean = mean_of_view(ReferenceScene(scene), ortho_camera(Vec3(0, 0, 5), Vec3(0), 2.0), 400);
    const double expected = 2.0 / (3.0 * kPi) * (std::sin(phase) + (kPi - phase) * std::cos(phase));
    EXPECT_NEAR(mean.color.y * 4.0 / kPi, expected, 1e-4) << phase;
  }
}

TEST(ReferenceLight, FallsOffOverAPlaneByTheDistanceToTheLight) {
  for (const double k : {0.0, 1.0, 1e6}) {
    Scene scene = dark_scene();
    scene.attenuation = {AttenuationMode::linear, k};
    add_object(scene, PlaneShape{}, add_material(scene, matte(Color(0.7))));
    add_point_light(scene, Vec3(0, 1, 0), 3.0);
    const ReferenceScene plane(scene);
    for (const double foot : {0.0, 0.5, 2.0, 100.0}) {
      const double rho = std::sqrt(1.0 + foot * foot);
      const double expected = 0.7 * 3.0 * (1.0 / rho) / (rho + k);
      const double seen = look(plane, Vec3(foot, 9, 0), Vec3(0, -1, 0)).pixel.color.x;
      EXPECT_NEAR(seen / expected, 1.0, 1e-12) << k << " " << foot;
    }
  }
}

TEST(ReferenceLight, KnowsThreeAttenuationsAndNeverWeakensDirectionalLight) {
  const auto seen = [](AttenuationMode mode, bool directional) {
    Scene scene = dark_scene();
    scene.attenuation = {mode, 2.0};
    add_object(scene, PlaneShape{}, add_material(scene, matte(Color(1.0))));
    directional ? add_directional_light(scene, Vec3(0, -3, 0)) : add_point_light(scene, Vec3(0, 4, 0));
    return look(ReferenceScene(scene), Vec3(0, 1, 0), Vec3(0, -1, 0)).pixel.color.x;
  };
  EXPECT_NEAR(seen(AttenuationMode::linear, false), 1.0 / 6.0, 1e-15);
  EXPECT_NEAR(seen(AttenuationMode::inverse_square, false), 1.0 / 18.0, 1e-15);
  EXPECT_NEAR(seen(AttenuationMode::none, false), 1.0, 1e-15);
  for (const auto mode : {AttenuationMode::linear, AttenuationMode::inverse_square, AttenuationMode::none})
    EXPECT_NEAR(seen(mode, true), 1.0, 1e-15);
}

// The mean over the disc, as the integral over s = (distance from its middle)^2, of a sphere with a light at the eye.
double head_light_mean(double n, double s_max) {
  Scene scene = dark_scene();
  Material shiny = matte(Color(0.0));
  shiny.specular = Color(1.0);
  shiny.shininess = n;
  add_object(scene, SphereShape{}, add_material(scene, shiny));
  add_directional_light(scene, Vec3(0, 0, -1));
  const ReferenceScene sphere(scene);
  const ReferenceEye eye = make_reference_eye(sphere, square_view(1), ortho_camera(Vec3(0, 0, 5), Vec3(0), 2.0));
  constexpr int kSteps = 4000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double s = s_max * (i + 0.5) / kSteps;
    sum += reference_sample(sphere, eye, Vec2(0.5 + 0.5 * std::sqrt(s), 0.5)).color.x;
  }
  return sum * s_max / kSteps;
}

TEST(ReferenceLight, GivesAHeadLitPhongSphereItsMeanForEveryExponent) {
  for (const double n : {0.0, 1.0, 1e2, 1e4, 1e6, 1e9}) {
    const double s_max = std::min(0.5, 20.0 / (n + 1.0));  // beyond it the lobe is under e^-40
    EXPECT_NEAR(head_light_mean(n, s_max) * 2.0 * (n + 1.0), 1.0, 1e-3) << n;
  }
}

TEST(TextbookForms, MakeTheHighlightFourTimesTooLargeByTheAngleOfIncidence) {
  const double n = 100.0;
  constexpr int kSteps = 4000;
  double wrong = 0.0;  // (N.L)^n in place of (R.V)^n over the same disc, N.L = sqrt(1 - s)
  for (int i = 0; i < kSteps; ++i) wrong += std::pow(1.0 - (i + 0.5) / kSteps, 0.5 * n) / kSteps;
  EXPECT_NEAR(wrong, 2.0 / (n + 2.0), 1e-4);
  EXPECT_GT(wrong, 3.9 * head_light_mean(n, 0.5));
}

TEST(ReferenceLight, HasNoHighlightWhereTheMirroredLightPointsAwayThoughTheExponentIsZero) {
  Scene scene = dark_scene();
  Material shiny = matte(Color(0.0));
  shiny.specular = Color(1.0);
  shiny.shininess = 0.0;
  add_object(scene, PlaneShape{}, add_material(scene, shiny));
  add_directional_light(scene, Vec3(1, -0.2, 0));  // mirrored: toward +x
  const ReferenceScene plane(scene);
  EXPECT_EQ(look(plane, Vec3(3, 1, 0), Vec3(-3, -1, 0)).pixel.color, Color(1.0));
  EXPECT_EQ(look(plane, Vec3(-9, 1, 0), Vec3(9, -1, 0)).pixel.color, Color(0.0));
}

TEST(ReferenceLight, LightsBothSidesOfASurfaceAlike) {
  Scene scene = dark_scene();
  add_object(scene, BoxShape{Vec3(-5, 0, -5), Vec3(5, 0, 5)}, add_material(scene, matte(Color(1.0))));
  add_point_light(scene, Vec3(1, 2, 3));
  add_point_light(scene, Vec3(1, -2, 3)).color = Color(0, 1, 0);
  const ReferenceScene sheet(scene);
  const Color above = look(sheet, Vec3(0, 4, 0), Vec3(0, -1, 0)).pixel.color;
  const Color below = look(sheet, Vec3(0, -4, 0), Vec3(0, 1, 0)).pixel.color;
  EXPECT_GT(above.x, 0.1);
  EXPECT_EQ(below, Color(0, above.y, 0));  // only the green light is on this side
}

TEST(ReferenceLight, SumsItsLights) {
  Scene scene = dark_scene();
  scene.ambient = Color(0.5);
  Material ivory;
  ivory.specular = Color(0.5);
  add_object(scene, SphereShape{}, add_material(scene, ivory));
  const auto seen = [&](std::vector<Light> lights) {
    Scene lit = scene;
    lit.lights = std::move(lights);
    return look(ReferenceScene(lit), Vec3(0.3, 0.4, 5), Vec3(0, 0, -1)).pixel.color;
  };
  const Light a = add_point_light(scene, Vec3(3, 3, 3)), b = add_directional_light(scene, Vec3(1, -1, -1), 0.3);
  EXPECT_LT(glm::length(seen({a, b}) - (seen({a}) + seen({b}) - seen({}))), 1e-15);
}

TEST(ReferenceShadow, IsBlackBehindAnOpaqueBodyAndOnlyThere) {
  Scene scene = dark_scene();
  add_object(scene, PlaneShape{}, add_material(scene, matte(Color(1.0))));
  add_object(scene, SphereShape{Vec3(0, 2, 0), 1.0});
  add_point_light(scene, Vec3(0, 4, 0));
  // The cone that touches the sphere meets the floor at radius 4 / sqrt(4 - 1).
  const double edge = 4.0 / std::sqrt(3.0);
  const auto at = [&](const Scene& s, double x, const View& view) {
    return look(ReferenceScene(s), Vec3(x, 0.5, 0), Vec3(0, -1, 0), view).pixel.color.x;
  };
  View view = square_view(1);
  EXPECT_EQ(at(scene, edge - 1e-9, view), 0.0);
  EXPECT_GT(at(scene, edge + 1e-9, view), 0.5);
  view.render.shadows = false;
  EXPECT_GT(at(scene, 0.0, view), 0.5);
  scene.lights[0].shadow = false;
  EXPECT_GT(at(scene, 0.0, square_view(1)), 0.5);
}

TEST(ReferenceShadow, OfAGrazingLightNeverFallsOnThePlaneItself) {
  for (const double elevation_deg : {0.1, 0.001}) {
    const double e = elevation_deg * kPi / 180.0;
    Scene scene = dark_scene();
    add_object(scene, PlaneShape{Vec3(0.1, 0.2, 0.3), Vec3(0.3, 0.9, -0.2)}, add_material(scene, matte(Color(1.0))));
    const Vec3 n = glm::normalize(Vec3(0.3, 0.9, -0.2)), along = glm::normalize(glm::cross(n, Vec3(0, 0, 1)));
    add_directional_light(scene, -(std::cos(e) * along + std::sin(e) * n));
    const ReferenceScene plane(scene);
    Uniform uniform(6);
    for (int i = 0; i < 1000; ++i)
      ASSERT_NEAR(look(plane, 9.0 * n + uniform.direction(), -n).pixel.color.x / std::sin(e), 1.0, 1e-9);
  }
}

TEST(ReferenceShadow, IsTintedByTheProductOverTheSurfacesCrossed) {
  const Color red(0.9, 0.5, 0.4), blue(0.3, 0.6, 0.8);
  Scene scene = dark_scene();
  add_object(scene, PlaneShape{}, add_material(scene, matte(Color(1.0))));
  add_object(scene, SphereShape{Vec3(0, 5, 0), 1.0}, add_material(scene, clear(Color(0.0), red)));
  add_object(scene, BoxShape{Vec3(-1, 2, -1), Vec3(1, 3, 1)}, add_material(scene, clear(Color(0.0), blue)));
  add_object(scene, PlaneShape{Vec3(0, 8, 0)}, add_material(scene, clear(Color(0.0), Color(0.5))));
  add_directional_light(scene, Vec3(0, -1, 0));
  const Color seen = look(ReferenceScene(scene), Vec3(0.2, 1, 0.1), Vec3(0, -1, 0)).pixel.color;
  EXPECT_LT(glm::length(seen - red * red * blue * blue * 0.5), 1e-15);  // two surfaces a solid, one a sheet
}

TEST(ReferenceShadow, KeepsItsTintWhenAGlassBodyStandsOnTheFloor) {
  const Color green(0.2, 0.9, 0.3);
  for (const bool floor_first : {true, false}) {
    Scene scene = dark_scene();
    const MaterialId floor = add_material(scene, matte(Color(1.0)));
    const MaterialId glass = add_material(scene, clear(Color(0.0), green, 1.0));
    if (floor_first) add_object(scene, PlaneShape{}, floor);
    add_object(scene, BoxShape{Vec3(-1, 0, -1), Vec3(1, 2, 1)}, glass);
    if (!floor_first) add_object(scene, PlaneShape{}, floor);
    add_directional_light(scene, Vec3(0.1, -1, 0));
    const double n_l = 1.0 / std::sqrt(1.01);
    // The eye is in the glass. The floor hides the foot in the same place, and light comes in through the top alone.
    const Color seen = look(ReferenceScene(scene), Vec3(0.2, 1, 0.1), Vec3(0, -1, 0)).pixel.color;
    EXPECT_LT(glm::length(seen - n_l * green), 1e-15) << floor_first;
  }
}

TEST(ReferenceChecker, CountsCellsOnTheTwoAxesOfTheFace) {
  Scene scene = dark_scene();
  scene.ambient = Color(1.0);
  Material tiles = matte(Color(0.0));
  tiles.ambient = Checker{Color(1.0), Color(0.0), 0.5};
  add_object(scene, BoxShape{Vec3(-2, -2, -2), Vec3(2, 2, 2)}, add_material(scene, tiles));
  const ReferenceScene box(scene);
  Uniform uniform(7);
  for (int i = 0; i < 500; ++i) {
    const double x = uniform.between(-2, 2), z = uniform.between(-2, 2);
    const bool odd = static_cast<int>(std::floor(x / 0.5) + std::floor(z / 0.5)) % 2 != 0;
    ASSERT_EQ(look(box, Vec3(x, 5, z), Vec3(0, -1, 0)).pixel.color.x, odd ? 0.0 : 1.0) << x << " " << z;
    ASSERT_EQ(look(box, Vec3(x, z, 5), Vec3(0, 0, -1)).pixel.color.x, odd ? 0.0 : 1.0) << x << " " << z;
  }
}

TEST(ReferenceChecker, IsThreeDimensionalOnSpheres) {
  Scene scene = dark_scene();
  scene.ambient = Color(1.0);
  Material tiles = matte(Color(0.0));
  tiles.ambient = Checker{Color(1.0), Color(0.0), 0.7};
  add_object(scene, SphereShape{Vec3(5, 6, 7), 2.0}, add_material(scene, tiles));
  const ReferenceScene sphere(scene);
  Uniform uniform(8);
  for (int i = 0; i < 500; ++i) {
    const Vec3 d = uniform.direction();
    const Vec3 cell = glm::floor(2.0 * d / 0.7);
    const bool odd = static_cast<int>(cell.x + cell.y + cell.z) % 2 != 0;
    ASSERT_EQ(look(sphere, Vec3(5, 6, 7), d).pixel.color.x, odd ? 0.0 : 1.0);
  }
}

TEST(ReferenceChecker, TellsTheSizeOfItsCellsInPixels) {
  Scene scene = dark_scene();
  Material tiles = matte(Color(0.0));
  tiles.diffuse = Checker{Color(1.0), Color(0.0), 0.5};
  add_object(scene, PlaneShape{}, add_material(scene, tiles));
  add_object(scene, PlaneShape{Vec3(0, 20, 0)}, add_material(scene, clear(Color(1.0), Color(0.0))));
  const ReferenceScene plane(scene);
  const View view = square_view(100);
  // A pixel is 2 tan(fov / 2) / 100 wide at distance 1.
  const double pixel = 2.0 * 0.4 / 100.0;
  const auto cell = [&](const Vec3& position, const Vec3& target) {
    const Camera camera = perspective_camera(position, target, 0.4);
    return reference_sample(plane, make_reference_eye(plane, view, camera), Vec2(50, 50)).checker_cell_px;
  };
  EXPECT_NEAR(cell(Vec3(0, 10, 0), Vec3(0)), 0.5 / (10.0 * pixel), 1e-3 * 0.5 / (10.0 * pixel));
  EXPECT_NEAR(cell(Vec3(0, 10, 0), Vec3(0, 20, 0)), 0.5 / (30.0 * pixel), 1e-3 * 0.5 / (30.0 * pixel));
}

TEST(ReferenceBackground, IsMixedByTheHeightOfTheUnitDirection) {
  Scene scene = dark_scene();
  scene.background = {Color(0.2, 0.4, 0.6), Color(1.0, 0.0, 0.5)};
  add_object(scene, SphereShape{Vec3(0, 0, 100), 0.1});
  const ReferenceScene sky(scene);
  Uniform uniform(9);
  for (int i = 0; i < 100; ++i) {
    const Vec3 d = uniform.direction();
    if (d.z > 0.99) continue;
    const double mix = 0.5 * (1.0 + d.y);
    const Color expected = (1.0 - mix) * scene.background.bottom + mix * scene.background.top;
    EXPECT_LT(glm::length(look(sky, Vec3(1, 2, 3), 7.0 * d).pixel.color - expected), 1e-14);
  }
}

}  // namespace
}  // namespace tilelight
