// SPDX-License-Identifier: Apache-2.0
// What cannot reach the picture of a view is left out, and nothing else: closed cases, and bytes that stay the same
// with the kernel that can do everything.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "renderer/compile/reach.h"
#include "renderer/renderer.h"
#include "tests/unit/agreement_scenes.h"

namespace tilelight {
namespace {

// An eye at the origin that looks along -z at what `objects` are, with a mirror and a glass to wear.
class Reaches : public testing::Test {
 protected:
  struct Planned {
    std::shared_ptr<const CompiledScene> scene;
    ViewPlan plan;
    bool has(Feature f) const { return plan.features.has(f); }
    bool leaves_out(const std::string& what) const {
      const auto& list = plan.plan.left_out;
      return std::any_of(list.begin(), list.end(), [&](const LeftOut& item) { return item.what == what; });
    }
  };

  Planned plan(const std::string& objects, const std::string& lights = kLightAbove) {
    const std::string json = R"({"image": {"width": 64, "height": 48}, "render": {"samples": 4},
      "camera": {"position": [0, 0, 0], "target": [0, 0, -1]},
      "materials": {"mirror": {"reflection": 0.5}, "glass": {"diffuse": 0, "transmission": 0.8}},
      "lights": [)" + lights +
                             R"(], "objects": [)" + objects + "]}";
    const auto parsed = parse_scene(json, Limits{});
    if (!parsed) ADD_FAILURE() << parsed.error().errors[0].detail << json;
    Planned out{compile_scene(parsed->scene, pool_), {}};
    out.plan = plan_view(*out.scene, parsed->view);
    return out;
  }

  std::vector<float> picture(const std::shared_ptr<const CompiledScene>& scene, const ViewPlan& view) {
    const auto render = Render::start(pool_, Priority::normal, scene, view);
    render->wait_ms(1e12);
    return render->image()->rgb;
  }
  bool is_same_as_by_the_full_kernel(const std::shared_ptr<const CompiledScene>& scene, const ViewPlan& chosen) {
    ViewPlan full = chosen;
    full.variant = KernelVariant::glass_shadows;
    return picture(scene, chosen) == picture(scene, full);
  }

  static constexpr const char* kLightAbove = R"({"type": "point", "position": [0, 9, -5], "intensity": 9})";
  TilePool pool_{2};
};

constexpr const char* kBall = R"({"type": "sphere", "center": [0, 0, -5]})";

TEST_F(Reaches, NoMirrorBehindTheEyeWhereNothingInThePictureMirrors) {
  const Planned p = plan(std::string(kBall) + R"(, {"type": "sphere", "center": [0, 0, 5], "material": "mirror"})");
  EXPECT_FALSE(p.has(Feature::reflection));
  EXPECT_TRUE(p.leaves_out("feature reflection"));
  EXPECT_TRUE(p.leaves_out("body objects/1"));
  EXPECT_TRUE(is_same_as_by_the_full_kernel(p.scene, p.plan));
}

TEST_F(Reaches, EverythingByAMirrorThatIsSeen) {
  const Planned p = plan(R"({"type": "sphere", "center": [0, 0, -5], "material": "mirror"},
                            {"type": "sphere", "center": [0, 0, 5], "material": "glass"})");
  EXPECT_TRUE(p.has(Feature::transmission));
  EXPECT_FALSE(p.leaves_out("body objects/1"));
}

TEST_F(Reaches, WhatStandsBetweenThePictureAndALight) {
  const std::string ball = std::string(kBall) + ", ";
  // Above the picture and below the light, which is 9 above the ball; then beside the way, and behind the light.
  const std::string between = R"({"type": "sphere", "center": [0, 6, -5], "radius": 0.5, "material": "glass"})";
  const std::string beside = R"({"type": "sphere", "center": [8, 6, -5], "radius": 0.5, "material": "glass"})";
  const std::string beyond = R"({"type": "sphere", "center": [0, 12, -5], "radius": 0.5, "material": "glass"})";
  EXPECT_TRUE(plan(ball + between).has(Feature::tinted_shadows));
  EXPECT_FALSE(plan(ball + between).has(Feature::transmission));
  EXPECT_FALSE(plan(ball + beside).has(Feature::tinted_shadows));
  EXPECT_FALSE(plan(ball + beyond).has(Feature::tinted_shadows));
  const std::string sun = R"({"type": "directional", "direction": [0, -1, 0]})";
  EXPECT_TRUE(plan(ball + between, sun).has(Feature::tinted_shadows));
  EXPECT_FALSE(plan(ball + beside, sun).has(Feature::tinted_shadows));
  EXPECT_TRUE(plan(ball + beyond, sun).has(Feature::tinted_shadows));
  for (const std::string& other : {between, beside, beyond}) {
    for (const std::string& light : {std::string(kLightAbove), sun}) {
      const Planned p = plan(ball + other, light);
      EXPECT_TRUE(is_same_as_by_the_full_kernel(p.scene, p.plan)) << other << light;
    }
  }
}

TEST_F(Reaches, WhatALightBehindTheEyeThrowsIntoThePicture) {
  const std::string behind = R"({"type": "point", "position": [0, 0, 9], "intensity": 9})";
  const Planned p =
      plan(std::string(kBall) + R"(, {"type": "sphere", "center": [0, 0.2, 4], "radius": 0.5, "material": "glass"})",
           behind);
  EXPECT_TRUE(p.has(Feature::tinted_shadows));
  EXPECT_TRUE(is_same_as_by_the_full_kernel(p.scene, p.plan));
}

TEST_F(Reaches, APlaneThatIsSeenByItsShadowsFromOutsideThePicture) {
  const std::string floor = R"({"type": "plane", "point": [0, -1, 0]}, )";
  const std::string glass = R"({"type": "sphere", "center": [0, 6, -5], "radius": 0.5, "material": "glass"})";
  const std::string mirror = R"({"type": "sphere", "center": [0, 6, -5], "radius": 0.5, "material": "mirror"})";
  EXPECT_TRUE(plan(floor + glass).has(Feature::tinted_shadows));
  EXPECT_FALSE(plan(floor + mirror).has(Feature::reflection));  // its shadow is seen, its surface is not
  EXPECT_FALSE(plan(floor + mirror).leaves_out("body objects/1"));
}

TEST_F(Reaches, TheMediumInWhichTheEyeStands) {
  const Planned p = plan(R"({"type": "sphere", "center": [0, 0, 0.9], "material": "glass"}, )" + std::string(kBall));
  EXPECT_TRUE(p.has(Feature::transmission));
}

TEST_F(Reaches, ABodyOnThePicturesBorder) {
  // The picture's upper border is a plane through the eye, at 20 degrees, so that 2 before it the border lies this
  // high. A pixel is 0.0303 there, and two are left for the filter. Of the box the lower edge away from the eye comes
  // nearest.
  const double border = 2.0 * 0.3639702;
  const auto box = [&](double above) {
    const std::string lo = std::to_string(border + above), hi = std::to_string(border + above + 0.1);
    return R"({"type": "box", "min": [-0.1, )" + lo + R"(, -2], "max": [0.1, )" + hi +
           R"(, -1.9], "material": "mirror"})";
  };
  EXPECT_TRUE(plan(std::string(kBall) + ", " + box(-0.01)).has(Feature::reflection));
  EXPECT_FALSE(plan(std::string(kBall) + ", " + box(0.065)).has(Feature::reflection));
}

TEST_F(Reaches, ASphereOnThePicturesBorder) {
  const auto sphere = [](double radius) {
    return R"({"type": "sphere", "center": [0, 5.06, -2], "radius": )" + std::to_string(radius) +
           R"(, "material": "mirror"})";
  };
  const double away = 5.06 * 0.9396926 - 2 * 0.3420201;  // of the centre from that border: 4.07
  EXPECT_TRUE(plan(std::string(kBall) + ", " + sphere(away + 0.01)).has(Feature::reflection));
  // Asked is the box around it, whose corner reaches farther.
  EXPECT_FALSE(plan(std::string(kBall) + ", " + sphere(0.75 * away)).has(Feature::reflection));
}

TEST_F(Reaches, NoShadowsOfTheOneConvexBodyThatHasAPartInThePicture) {
  const Planned p = plan(std::string(kBall) + R"(, {"type": "sphere", "center": [0, -30, 5]})");
  EXPECT_FALSE(p.has(Feature::shadows));
  EXPECT_TRUE(is_same_as_by_the_full_kernel(p.scene, p.plan));
}

TEST_F(Reaches, NothingAtAllWhereTheEyeLooksAway) {
  const Planned p = plan(R"({"type": "sphere", "center": [0, 0, 5], "material": "glass"})");
  EXPECT_EQ(p.plan.variant, KernelVariant::local);
  EXPECT_EQ(p.plan.features, FeatureSet{});
  EXPECT_TRUE(is_same_as_by_the_full_kernel(p.scene, p.plan));
}

TEST_F(Reaches, NoMoreShadowRaysThanAPlanWithoutThemSaysTheyWouldHaveCost) {
  const std::string two = std::string(kBall) + R"(, {"type": "sphere", "center": [1, 0, -7]})";
  const Planned with = plan(two);
  View plain = with.plan.view;
  plain.render.shadows = false;
  const ViewPlan off = plan_view(*with.scene, plain);
  const auto said = std::find_if(off.plan.left_out.begin(), off.plan.left_out.end(),
                                 [](const LeftOut& item) { return item.what == "feature shadows"; });
  ASSERT_NE(said, off.plan.left_out.end());
  EXPECT_EQ(said->cost, "up to 12300 shadow rays at first hits");  // 64 * 48 * 4 = 12288
  const auto render = Render::start(pool_, Priority::normal, with.scene, with.plan);
  render->wait_ms(1e12);
  EXPECT_GT(render->report().points.back().rays.shadow, 0);
  EXPECT_LE(render->report().points.back().rays.shadow, 12288);
}

TEST_F(Reaches, ManyBodiesAreLeftOutInOneLine) {
  std::string objects = kBall;
  for (int i = 0; i < 9; ++i) objects += R"(, {"type": "sphere", "center": [)" + std::to_string(3 * i) + ", 0, 9]}";
  EXPECT_TRUE(plan(objects).leaves_out("9 bodies"));
}

// Views of small parts of random scenes, in all projections, filters and depths.
TEST_F(Reaches, WhateverMayChangeTheBytesOfAPicture) {
  int leaner = 0, smaller = 0;
  for (uint64_t seed = 0; seed < 150; ++seed) {
    agreement::RandomScene random = agreement::make_random_scene(seed, 24);
    Camera& camera = *random.view.camera;
    const double angle = 2.4 * static_cast<double>(seed);
    camera.target += 0.4 * glm::length(camera.target - camera.position) *
                     Vec3(std::sin(angle), 0.3 * std::cos(3.0 * angle), std::cos(angle));
    camera.fov_y_deg = 1.0 + static_cast<double>(seed % 30);
    camera.height *= 0.2;
    random.view.render.samples = 2;
    random.view.render.filter = static_cast<PixelFilter>(seed % 3);
    if (seed % 4 == 0) random.view.render.max_depth = 0;
    const auto scene = compile_scene(random.scene, pool_);
    const ViewPlan chosen = plan_view(*scene, random.view);
    EXPECT_TRUE(is_same_as_by_the_full_kernel(scene, chosen)) << "scene " << seed;
    leaner += chosen.variant != choose_variant(scene->plan.features);
    smaller += find_reach(*scene, chosen).count() < scene->bodies.size();
  }
  EXPECT_GE(leaner, 15);
  EXPECT_GE(smaller, 50);
}

}  // namespace
}  // namespace tilelight
