// SPDX-License-Identifier: Apache-2.0
// The sets of media against a plain list.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "renderer/shade/media.h"

namespace tilelight {
namespace {

// Bodies 0, 1, ... of priorities 0, 1, 2, 0, 1, 2, ..., each of its own index of refraction.
CompiledScene many_media(uint32_t count) {
  CompiledScene scene;
  for (uint32_t i = 0; i < count; ++i) {
    CompiledMaterial m;
    m.source.ior = 1.0 + i;
    m.source.priority = static_cast<int>(i % 3);
    scene.materials.push_back(m);
    CompiledBody body;
    body.material = i;
    scene.bodies.push_back(body);
  }
  return scene;
}

// The same by the book: a list in the order of entering.
struct PlainList {
  std::vector<uint32_t> bodies;
  uint32_t top() const {
    uint32_t best = kNone;
    for (const uint32_t b : bodies) {
      if (best == kNone || b % 3 >= best % 3) best = b;
    }
    return best;
  }
  bool contains(uint32_t body) const { return std::find(bodies.begin(), bodies.end(), body) != bodies.end(); }
  void leave(uint32_t body) { bodies.erase(std::next(std::find(bodies.rbegin(), bodies.rend(), body)).base()); }
};

TEST(MediaSets, FollowAPlainListThroughAnyCrossings) {
  constexpr uint32_t kBodies = 60;
  const CompiledScene scene = many_media(kBodies);
  MediaSets sets(scene);
  std::mt19937 random(1);
  std::vector<std::pair<MediaSets::Set, PlainList>> known = {{MediaSets::kOpenAir, {}}};
  for (int step = 0; step < 20000; ++step) {
    // From any set that was ever made, mostly from the last one: rays branch.
    const size_t from = random() % 4 ? known.size() - 1 : random() % known.size();
    auto [set, list] = known[from];
    const auto body = static_cast<uint32_t>(random() % kBodies);
    if (list.contains(body) && random() % 3) {
      set = sets.without(set, body);
      list.leave(body);
    } else {
      set = sets.with(set, body);
      list.bodies.push_back(body);
    }
    ASSERT_EQ(sets.top(set), list.top()) << step;
    ASSERT_EQ(sets.ior(set), list.bodies.empty() ? 1.0 : 1.0 + list.top()) << step;
    const auto asked = static_cast<uint32_t>(random() % kBodies);
    ASSERT_EQ(sets.contains(set, asked), list.contains(asked)) << step;
    known.emplace_back(set, list);
  }
}

TEST(MediaSets, ForgetNoneOfAThousandMediaInsideEachOther) {
  constexpr uint32_t kBodies = 1000;
  CompiledScene scene = many_media(kBodies);
  for (CompiledMaterial& m : scene.materials) m.source.priority = 0;
  MediaSets sets(scene);
  MediaSets::Set set = MediaSets::kOpenAir;
  for (uint32_t i = 0; i < kBodies; ++i) set = sets.with(set, i);
  for (uint32_t i = kBodies; i-- > 0;) {
    ASSERT_EQ(sets.top(set), i);
    set = sets.without(set, i);
  }
  EXPECT_EQ(set, MediaSets::kOpenAir);
}

TEST(MediaSets, GrowByAHandfulOfNodesACrossingHoweverManyMediaOverlap) {
  constexpr uint32_t kBodies = 500;
  const CompiledScene scene = many_media(kBodies);
  MediaSets sets(scene);
  MediaSets::Set set = MediaSets::kOpenAir;
  for (uint32_t i = 0; i < kBodies; ++i) set = sets.with(set, i);
  for (uint32_t i = 0; i < kBodies; ++i) set = sets.without(set, i);  // first in, first out
  EXPECT_EQ(set, MediaSets::kOpenAir);
  EXPECT_LE(sets.size(), size_t{4 * kBodies + 20});
}

// Bodies 0 to 5 of priorities 0, 1, 2, 0, 1, 2; ranks the other way round.
class Crossings : public testing::Test {
 protected:
  Crossings() : scene_(many_media(6)), sets_(scene_) {
    for (uint32_t i = 0; i < 6; ++i) scene_.bodies[i].rank = 5 - i;
  }
  Crossing cross(const std::vector<uint32_t>& media, const std::vector<uint32_t>& entered,
                 const std::vector<uint32_t>& left, const std::vector<uint32_t>& thinner = {}) {
    return {sets_, sets_.of(media), entered, left, thinner};
  }
  uint32_t top_before(const Crossing& c) { return sets_.top(c.before); }
  uint32_t top_after(const Crossing& c) { return sets_.top(c.after); }

  CompiledScene scene_;
  MediaSets sets_;
};

TEST_F(Crossings, FromOneMediumIntoAnotherAreOneInterfaceBothWays) {
  const Crossing down = cross({0}, {3}, {0}), up = cross({3}, {0}, {3});
  EXPECT_EQ(top_before(down), 0u);
  EXPECT_EQ(top_after(down), 3u);
  EXPECT_EQ(top_before(up), 3u);
  EXPECT_EQ(top_after(up), 0u);
  EXPECT_EQ(down.seen, 3u) << "the lower rank";
  EXPECT_EQ(up.seen, down.seen);
}

TEST_F(Crossings, InsideAMediumOfHigherPriorityAreNotSeen) {
  EXPECT_FALSE(cross({2, 0}, {3}, {0}).is_seen());
  EXPECT_TRUE(cross({2, 0}, {3}, {2}).is_seen());
  EXPECT_EQ(cross({2, 0}, {3}, {2}).seen, 3u) << "3 bounds what comes and 2 what was; 3 has the lower rank";
}

TEST_F(Crossings, OfWhatWasNotEnteredCountItAsEntered) {
  const Crossing c = cross({}, {3}, {0});
  EXPECT_EQ(top_before(c), 0u);
  EXPECT_EQ(top_after(c), 3u);
}

TEST_F(Crossings, IntoSeveralAtOnceShowTheInnermostOfEquals) {
  const Crossing c = cross({}, {0, 3}, {});
  EXPECT_EQ(top_after(c), 3u);
  EXPECT_EQ(c.seen, 3u);
  EXPECT_EQ(cross({}, {3, 0}, {}).seen, 0u);
}

TEST_F(Crossings, OfABodyThatIsThinInThePlaceChangeNoMedium) {
  const Crossing c = cross({0}, {}, {}, {1});
  EXPECT_EQ(c.before, c.after);
  EXPECT_EQ(c.seen, 1u);
  EXPECT_FALSE(cross({2}, {}, {}, {1}).is_seen()) << "the medium around it has the higher priority";
}

}  // namespace
}  // namespace tilelight
