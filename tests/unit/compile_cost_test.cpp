// SPDX-License-Identifier: Apache-2.0
// What a plan says that left-out things would have cost: counts of the scene and the view, and nothing where there is
// nothing to count.
#include <gtest/gtest.h>

#include <algorithm>

#include "renderer/compile/compile.h"
#include "renderer/compile/compiled_scene.h"
#include "renderer/compile/cost_text.h"

namespace tilelight {
namespace {

class Costs : public testing::Test {
 protected:
  Costs() {
    scene_.materials.resize(1);
    for (const double x : {-2.0, 2.0}) scene_.objects.emplace_back().shape = SphereShape{Vec3(x, 0.0, 0.0), 1.0};
    scene_.lights.resize(3);
    view_.image.width = 50, view_.image.height = 40;
    view_.render.samples = 3;
  }

  std::string cost_of(const std::string& what) {
    const auto compiled = compile_scene(scene_, pool_);
    const auto& list = plan_view(*compiled, view_, "").plan.left_out;
    const auto item = std::find_if(list.begin(), list.end(), [&](const LeftOut& l) { return l.what == what; });
    return item == list.end() ? "not left out" : item->cost;
  }

  Scene scene_;
  View view_;
  TilePool pool_{1};
};

TEST_F(Costs, OfShadowsAreARayForEachLightAtEachSample) {
  view_.render.shadows = false;
  EXPECT_EQ(cost_of("feature shadows"), "up to 18000 shadow rays at first hits");  // 50 * 40 * 3 samples * 3 lights
  scene_.lights[0].shadow = false;
  EXPECT_EQ(cost_of("feature shadows"), "up to 12000 shadow rays at first hits");
  view_.render.samples_implied = true;
  EXPECT_EQ(cost_of("feature shadows"), "up to 4000 shadow rays at first hits, for each sample a pixel");
}

TEST_F(Costs, OfADeadLightAreItsPartsOfTheLightEquation) {
  scene_.lights[1].intensity = 0.0;
  EXPECT_EQ(cost_of("light lights/1"), "up to 6000 evaluations of the light equation at first hits");
  view_.image.width = 5000, view_.image.height = 4000;
  EXPECT_EQ(cost_of("light lights/1"), "up to 60 million evaluations of the light equation at first hits");
}

TEST_F(Costs, OfDepthAreTheRaysOfTheFirstBounce) {
  scene_.materials[0].reflection = Color(0.5);
  view_.render.max_depth = 0;
  EXPECT_EQ(cost_of("feature reflection"), "up to 6000 reflected rays at first hits");
}

TEST_F(Costs, OfAKernelAreThoseOfTheAbilityThatItLacks) {
  EXPECT_EQ(cost_of("feature transmission"), "about 3 % of the time of a frame");
  scene_.materials[0].reflection = Color(0.5);
  EXPECT_EQ(cost_of("feature transmission"), "about 6 % of the time of a frame");
  scene_.materials[0].reflection = Color(0.0), scene_.materials[0].transmission = Color(0.5);
  EXPECT_EQ(cost_of("feature reflection"), "");  // what knows glass knows mirrors
  EXPECT_EQ(cost_of("feature planes"), "");
}

TEST_F(Costs, OfUnusedMaterialsAreBytes) {
  scene_.materials.emplace_back().name = "unworn";
  EXPECT_EQ(cost_of("material unworn"), std::to_string(sizeof(CompiledMaterial)) + " bytes");
  EXPECT_EQ(bytes_text(1536), "1.5 KiB");
  EXPECT_EQ(bytes_text(int64_t{300} << 20), "300 MiB");
}

}  // namespace
}  // namespace tilelight
