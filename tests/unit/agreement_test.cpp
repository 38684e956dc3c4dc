// SPDX-License-Identifier: Apache-2.0
// The kernels against the reference renderer on random scenes, by counts of pixels.
#include <gtest/gtest.h>

#include "renderer/measure/judge.h"
#include "tests/unit/agreement_scenes.h"

namespace tilelight {
namespace {

constexpr int kScenes = 200;
constexpr int kSizePx = 48;

TEST(Agreement, OfKernelsAndReferenceHoldsOnRandomScenes) {
  TilePool pool;
  ImageDifference total;
  for (uint64_t seed = 0; seed < kScenes; ++seed) {
    const agreement::RandomScene random = agreement::make_random_scene(seed, kSizePx);
    const ImageDifference d = judge_view(random.scene, random.view, pool).difference;
    // One scene may have a silhouette where rounding shows; ten pixels are something else.
    EXPECT_LE(d.id_mismatches, 3) << "scene " << seed;
    EXPECT_LE(d.q8_differing, 10) << "scene " << seed;
    total.pixels += d.pixels;
    total.id_mismatches += d.id_mismatches;
    total.q8_differing += d.q8_differing;
  }
  EXPECT_EQ(total.pixels, int64_t{kScenes} * kSizePx * kSizePx);
  EXPECT_LE(total.id_mismatch_rate(), kMaxIdMismatchRate) << total.id_mismatches << " pixels";
  EXPECT_LE(total.q8_rate(), kMaxQ8Rate) << total.q8_differing << " pixels";
}

}  // namespace
}  // namespace tilelight
