// SPDX-License-Identifier: Apache-2.0
// The floating-point settings of a host, kept out and given back.
#include <gtest/gtest.h>

#include <cfenv>

#include "renderer/base/standard_floats.h"
#include "tests/unit/host_floats.h"

namespace tilelight {
namespace {

// At run time: the compiler would round to nearest.
double third() {
  const volatile double one = 1.0, three = 3.0;
  return one / three;
}
double tiniest_half() {
  const volatile double least_normal = 0x1p-1022;
  return least_normal * 0.5;
}

TEST(StandardFloats, RoundToNearestWhateverTheHostHasSet) {
  const double nearest = third();
  test::on_host(test::Host::upwards, [&] {
    EXPECT_GT(third(), nearest);
    {
      const StandardFloats floats;
      EXPECT_EQ(third(), nearest);
    }
    EXPECT_GT(third(), nearest) << "the host gets its own back";
  });
}

TEST(StandardFloats, KeepSubnormalNumbersWhateverTheHostHasSet) {
  test::on_host(test::Host::flushing, [&] {
    {
      const StandardFloats floats;
      EXPECT_GT(tiniest_half(), 0.0);
    }
    if (test::kCanFlush) {
      EXPECT_EQ(tiniest_half(), 0.0) << "the host gets its own back";
    }
  });
}

TEST(StandardFloats, MayStandWithinOthers) {
  const double nearest = third();
  test::on_host(test::Host::upwards, [&] {
    const StandardFloats outer;
    { const StandardFloats inner; }
    EXPECT_EQ(third(), nearest);
  });
}

}  // namespace
}  // namespace tilelight
