// SPDX-License-Identifier: Apache-2.0
// The known failure of averaged normals, as the page's scene shows it: over the folds of a screen all vertex normals
// become equal, and the folds are gone. Splitting them at a crease angle is the cure.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "renderer/render/render.h"
#include "renderer/scene/parse.h"
#include "renderer/trace/primary_ids.h"

namespace tilelight {
namespace {

constexpr uint32_t kFolds = 12;  // of each screen, between two narrow hems, each of two triangles

struct Look {
  Algorithm algorithm;
  Shading shading;
};

ParsedScene ridge_scene() {
  std::ifstream file(TILELIGHT_SOURCE_DIR "/web/scenes/ridge.json");
  auto parsed = parse_scene(std::string{std::istreambuf_iterator<char>(file), {}}, Limits{});
  if (!parsed) throw std::runtime_error(parsed.error().errors.at(0).detail);
  parsed->view.image = {320, 180};
  parsed->view.render.samples = 1;
  return *std::move(parsed);
}

// (brightest - darkest) / mean over the folds of the screen with this id, linear green.
double variation(ParsedScene parsed, uint32_t body, const Look& look) {
  TilePool pool(2);
  parsed.view.render.algorithm = look.algorithm;
  parsed.view.render.shading = look.shading;
  const auto scene = compile_scene(parsed.scene, pool);
  const ViewPlan plan = plan_view(*scene, parsed.view);
  const auto render = Render::start(pool, Priority::normal, scene, plan);
  render->wait_ms(1e12);
  const auto image = render->image();
  const std::vector<uint64_t> ids = primary_ids(*scene, plan);
  double least = std::numeric_limits<double>::infinity(), most = 0.0, sum = 0.0;
  int pixels = 0;
  for (size_t i = 0; i < ids.size(); ++i) {
    const auto triangle = static_cast<uint32_t>(ids[i]);
    if (ids[i] >> 32 != body || triangle < 2 || triangle >= 2 + 2 * kFolds) continue;
    const double green = double{image->rgb[3 * i + 1]};
    least = std::min(least, green), most = std::max(most, green), sum += green, ++pixels;
  }
  EXPECT_GT(pixels, 5000);
  return (most - least) / (sum / pixels);
}

constexpr uint32_t kSmooth = 0, kCreased = 1;
constexpr Look kSmoothLooks[] = {{Algorithm::raytrace, Shading::phong},
                                 {Algorithm::raytrace, Shading::gouraud},
                                 {Algorithm::zbuffer, Shading::phong},
                                 {Algorithm::zbuffer, Shading::gouraud}};

TEST(Ridges, LookFlatWhereNormalsAreAveragedOverEveryEdge) {
  const ParsedScene parsed = ridge_scene();
  ASSERT_EQ(parsed.scene.meshes[kSmooth].crease_deg, 180.0);
  for (const Look& look : kSmoothLooks) EXPECT_LT(variation(parsed, kSmooth, look), 0.02);
}

TEST(Ridges, ShowWhereNormalsAreSplitAtTheCrease) {
  const ParsedScene parsed = ridge_scene();
  ASSERT_EQ(parsed.scene.meshes[kCreased].crease_deg, 30.0);
  for (const Look& look : kSmoothLooks) EXPECT_GT(variation(parsed, kCreased, look), 0.2);
}

TEST(Ridges, AreOneMeshThatDiffersInItsCreaseAlone) {
  ParsedScene parsed = ridge_scene();
  EXPECT_EQ(parsed.scene.meshes[kSmooth].positions, parsed.scene.meshes[kCreased].positions);
  EXPECT_EQ(parsed.scene.meshes[kSmooth].indices, parsed.scene.meshes[kCreased].indices);
  std::swap(parsed.scene.meshes[kSmooth].crease_deg, parsed.scene.meshes[kCreased].crease_deg);
  const Look gouraud{Algorithm::raytrace, Shading::gouraud};
  EXPECT_GT(variation(parsed, kSmooth, gouraud), 0.2);
  EXPECT_LT(variation(parsed, kCreased, gouraud), 0.02);
}

TEST(Ridges, ShowWhereEveryFaceIsLitForItself) {
  EXPECT_GT(variation(ridge_scene(), kSmooth, {Algorithm::raytrace, Shading::flat}), 0.2);
}

}  // namespace
}  // namespace tilelight
