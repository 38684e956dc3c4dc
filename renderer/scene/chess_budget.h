// SPDX-License-Identifier: Apache-2.0
// What chess pieces may cost in triangles, as an upper bound that limits can be checked against before any mesh exists.
#pragma once

#include <cstdint>

namespace tilelight {

inline constexpr int64_t kMenOfFullBoard = 32;

// At least as many triangles as any one piece has at this detail (segments around the axis). Lathes cost their segments
// squared, 200,000 at 512; the factor and the constant cover the queen's crown and the knight's head.
constexpr int64_t chess_piece_triangle_bound(int detail) {
  const int64_t squared = int64_t{detail} * detail;
  return 260'000 * squared / (512 * 512) + 2'000;
}

// The board's squares and moulded frame.
inline constexpr int64_t kBoardTriangleBound = 20'000;

}  // namespace tilelight
