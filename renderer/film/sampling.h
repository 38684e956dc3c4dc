// SPDX-License-Identifier: Apache-2.0
// The sampling pattern: two-dimensional Sobol points with Owen scrambling by hash (Laine and Karras 2011; Burley 2020,
// JCGT 9(4)), one sequence a pixel. Point i of a pixel depends on (pixel, seed, i) alone. Pure; any thread.
#pragma once

#include <cstdint>

#include "renderer/base/hash.h"

namespace tilelight {

struct SamplePoint {
  double x, y;  // inside the pixel, [0, 1)
};

namespace sobol {

inline uint32_t reverse_bits(uint32_t v) {
  v = (v & 0x5555'5555u) << 1 | (v >> 1 & 0x5555'5555u);
  v = (v & 0x3333'3333u) << 2 | (v >> 2 & 0x3333'3333u);
  v = (v & 0x0F0F'0F0Fu) << 4 | (v >> 4 & 0x0F0F'0F0Fu);
  v = (v & 0x00FF'00FFu) << 8 | (v >> 8 & 0x00FF'00FFu);
  return v << 16 | v >> 16;
}

// A permutation in which every bit is flipped or not by a hash of the bits below it: Owen's scrambling of the
// bit-reversed value (Laine and Karras 2011). Constants of Vegdahl 2021, "Building a Better LK Hash".
inline uint32_t scramble_upward(uint32_t v, uint32_t seed) {
  v ^= v * 0x3D20'ADEAu;
  v += seed;
  v *= seed >> 16 | 1u;
  v ^= v * 0x0552'6C56u;
  v ^= v * 0x53A2'2864u;
  return v;
}

// The bit-reversed second Sobol coordinate: Pascal's triangle modulo 2 times the index. The matrix is the fifth tensor
// power of [1 1; 0 1], so one step for each power of two replaces 32 direction numbers (Ahmed 2024).
inline uint32_t pascal(uint32_t index) {
  index ^= index >> 1 & 0x5555'5555u;
  index ^= index >> 2 & 0x3333'3333u;
  index ^= index >> 4 & 0x0F0F'0F0Fu;
  index ^= index >> 8 & 0x00FF'00FFu;
  return index ^ index >> 16;
}

}  // namespace sobol

// The sequence of the pixel (x, y). Uniform over the pixel; trace/pixel_filter.h bends it to another filter.
//
// Burley 2020 also shuffles the index, to pair independent point sets for more dimensions. There is one set a pixel
// here, and its scrambling alone makes it as random as a (0,2)-sequence can be.
inline SamplePoint sample_point(int x, int y, uint32_t seed, uint32_t index) {
  const uint64_t pixel = static_cast<uint64_t>(static_cast<uint32_t>(y)) << 32 | static_cast<uint32_t>(x);
  // Output number `seed` of the SplitMix64 generator that starts at the pixel.
  const uint64_t hash = mix64(pixel + seed * 0x9E37'79B9'7F4A'7C15ull);
  const uint32_t u = sobol::reverse_bits(sobol::scramble_upward(index, static_cast<uint32_t>(hash)));
  const uint32_t v =
      sobol::reverse_bits(sobol::scramble_upward(sobol::pascal(index), static_cast<uint32_t>(hash >> 32)));
  return {u * 0x1p-32, v * 0x1p-32};
}

}  // namespace tilelight
