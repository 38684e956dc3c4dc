// SPDX-License-Identifier: Apache-2.0
// Content hashes and the integer hash of the sampler. Pure; any thread.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tilelight {

// SHA-256 (FIPS 180-4) of the bytes, as 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view bytes);

// A 64-bit mixing function (the finaliser of SplitMix64, Steele, Lea and Flood 2014).
constexpr uint64_t mix64(uint64_t x) {
  x += 0x9E3779B97F4A7C15ull;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
  return x ^ (x >> 31);
}

}  // namespace tilelight
