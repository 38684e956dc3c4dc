// SPDX-License-Identifier: Apache-2.0
// Which way a picture stands whose camera's up lies along the view, and next to that: of the eye that all methods draw
// from, and of the reference's own.
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/compile/eye.h"
#include "renderer/scene/camera_up.h"
#include "tests/unit/reference_scenes.h"

namespace tilelight {
namespace {

struct Looking {
  const char* name;
  Vec3 forward, up;
  Vec3 right, top;  // of the picture, expected
};

const Vec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

const Looking kLookings[] = {
    {"down, default up: north is up", -kY, kY, kX, -kZ},
    {"down, up downwards", -kY, -3.0 * kY, kX, -kZ},
    {"up, default up: east stays on the right", kY, kY, kX, kZ},
    {"up, up downwards", kY, -kY, kX, kZ},
    {"north with up north", -kZ, -kZ, kX, kY},
    {"north with up south", -kZ, 2.0 * kZ, kX, kY},
    {"south with up south", kZ, kZ, -kX, kY},
    {"east with up east", kX, kX, kZ, kY},
    {"west with up east", -kX, kX, -kZ, kY},
    {"down by a rounding of a right angle", Vec3(6e-17, -1, 3e-17), kY, kX, -kZ},
    {"down, tilted a little from the south: as straight down", Vec3(0, -1, -1e-8), kY, kX, -kZ},
    {"down, tilted a little from the east: its own way", Vec3(-1e-8, -1, 0), kY, -kZ, -kX},
    {"up, tilted a little from the south: as straight up", Vec3(0, 1, -1e-8), kY, kX, kZ},
    {"down, up given north", -kY, -kZ, kX, -kZ},
    {"down, up given east", -kY, kX, kZ, kX},
};

class PicturesStand : public testing::TestWithParam<std::tuple<Looking, Projection>> {};
TEST_P(PicturesStand, AsTheRuleSays) {
  const auto& [looking, projection] = GetParam();
  Camera camera;
  camera.projection = projection;
  camera.position = -8.0 * looking.forward;
  camera.up = looking.up;
  const View view = reference_test::square_view(10);
  const Eye eye = make_eye(camera, 10, 10, Vec3(0.0), 1.0);
  const Scene scene = reference_test::dark_scene();
  const ReferenceEye reference = make_reference_eye(ReferenceScene(scene), view, camera);
  for (const auto& [right, down] : {std::pair(eye.step_x, eye.step_y), std::pair(reference.right, reference.down)}) {
    EXPECT_LT(glm::length(glm::normalize(right) - looking.right), 1e-7) << looking.name;
    EXPECT_LT(glm::length(glm::normalize(-down) - looking.top), 1e-7) << looking.name;
  }
}
INSTANTIATE_TEST_SUITE_P(Camera, PicturesStand,
                         testing::Combine(testing::ValuesIn(kLookings),
                                          testing::Values(Projection::perspective, Projection::orthographic)));

// A view tilted from the south: from level over the zenith the picture never jumps.
TEST(PicturesStand, WithoutAJumpOnTheWayToStraightDown) {
  const auto right_of = [](double height, double distance) {
    Camera camera;
    camera.position = Vec3(0, height, distance);
    return glm::normalize(make_eye(camera, 10, 10, Vec3(0.0), 1.0).step_x);
  };
  for (const double y : {8.0, -8.0}) {
    for (const double z : {8.0, 1.0, 1e-3, 1e-6, 1e-9, 1e-10, 1e-12, 1e-300, 0.0}) EXPECT_EQ(right_of(y, z), kX) << z;
  }
}

TEST(PicturesStand, AcrossAnyViewThatUpIsAlong) {
  for (const Vec3& view : {Vec3(1, 2, 3), Vec3(-3, -1.5, -5), Vec3(1e-200, 3e-200, 0), Vec3(1e200, -1e200, 1e200)}) {
    Camera camera;
    camera.position = -view;
    camera.up = 1.7 * view;
    EXPECT_TRUE(is_up_along_view(camera));
    EXPECT_EQ(usable_up(camera), kY);
    camera.up = kY;
    EXPECT_FALSE(is_up_along_view(camera));
  }
}

}  // namespace
}  // namespace tilelight
