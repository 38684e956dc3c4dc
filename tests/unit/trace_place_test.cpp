// SPDX-License-Identifier: Apache-2.0
// Places where a ray meets several surfaces at once.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/check/kit/shots.h"
#include "renderer/compile/compile.h"
#include "renderer/trace/place.h"
#include "renderer/trace/trace_rays.h"

namespace tilelight {
namespace {

// Three media with one face in common that end one after the other, each within rounding of the next: the first and
// the last do not end in one place, so the first of them to end is the innermost whatever the ranks.
TEST(Places, OfMediaThatEndInAChainOfTiesPutTheFirstToEndInside) {
  TilePool pool(2);
  std::array<double, 3> iors = {1.2, 1.4, 1.6};
  do {
    std::vector<Shape> shapes;
    for (const double steps : {0.0, 0.7, 1.4}) shapes.push_back(BoxShape{{0, -1, -1}, {1.0 + steps * 0x1p-40, 1, 1}});
    Scene scene = check::scene_of_shapes(shapes);
    scene.materials.resize(3);
    for (uint32_t i = 0; i < 3; ++i) {
      scene.materials[i].transmission = Color(0.9);
      scene.materials[i].ior = iors[i];
      scene.objects[i].material = i;
    }
    const auto compiled = compile_scene(scene, pool);
    const Ray ray{(Vec3(-0.5, 0.1, 0.2) - compiled->center) / compiled->units, {1, 0, 0}, {}, Coincident::none};
    const BoundedRay bounded{ray};
    Hit hit;
    trace_closest(*compiled, {&bounded, 1}, {&hit, 1});
    ASSERT_TRUE(hit.is_hit());
    MediaSets sets(*compiled);
    const Crossing crossing = PlaceCrosser(*compiled, sets).cross(ray, MediaSets::kOpenAir, hit);
    EXPECT_EQ(compiled->bodies[crossing.seen].body, 0u) << iors[0] << " " << iors[1] << " " << iors[2];
    EXPECT_EQ(sets.ior(crossing.after), iors[0]);
  } while (std::next_permutation(iors.begin(), iors.end()));
}

}  // namespace
}  // namespace tilelight
