// SPDX-License-Identifier: Apache-2.0
// S: spheres far, huge, tiny, grazed, and seen from inside.
#include "renderer/check/check.h"
#include "renderer/check/naive.h"
#include "renderer/check/rays.h"

namespace tilelight::check {
namespace {

// From the centre of the unit sphere every ray meets it at t = 1.
Outcome inside(const Context& context) {
  const RayScene scene(R"({"objects": [{"type": "sphere"}]})", context.pool);
  const int count = context.is_quick ? 10'000 : 1'000'000;
  int64_t misses = 0, textbook_misses = 0;
  double worst = 0.0;
  Random random(3);
  for (int i = 0; i < count; ++i) {
    const Vec3 direction = random.direction();
    const RayScene::Hit hit = scene.nearest(Vec3(0.0), direction);
    misses += !hit.is_hit;
    worst = std::max(worst, std::abs(hit.t - 1.0));
    // The rule "the smaller root, then its sign" takes the one behind the eye.
    const auto roots = naive::smaller_root({Vec3f(0.0f), Vec3f(direction)}, Vec3f(0.0f), 1.0f);
    textbook_misses += !(roots && *roots > 0.0f);
  }
  return {{at_most(0, "rays that miss", misses), at_most(1e-6, "t, off by", worst)},
          {at_most(0, "rays that miss", textbook_misses)}};
}

constexpr Row kRows[] = {
    {"S3", "eye in the centre of a sphere", "r = 1, distance 0", "the smaller root, then its sign", inside},
};

}  // namespace

std::span<const Row> sphere_rows() { return kRows; }

}  // namespace tilelight::check
