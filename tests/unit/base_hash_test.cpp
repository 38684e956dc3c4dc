// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "renderer/base/hash.h"

namespace tilelight {
namespace {

// The examples of NIST's FIPS 180 test vectors.
TEST(Sha256, AgreesWithThePublishedVectors) {
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

// The first outputs of SplitMix64 from seed 1234567, as its authors print them.
TEST(Mix64, IsSplitMix64) {
  constexpr uint64_t kStep = 0x9E3779B97F4A7C15ull;
  EXPECT_EQ(mix64(1234567), 6457827717110365317ull);
  EXPECT_EQ(mix64(1234567 + kStep), 3203168211198807973ull);
  EXPECT_EQ(mix64(1234567 + 2 * kStep), 9817491932198370423ull);
}

}  // namespace
}  // namespace tilelight
