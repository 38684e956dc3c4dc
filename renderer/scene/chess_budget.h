// SPDX-License-Identifier: Apache-2.0
// What chess pieces may cost in triangles, as an upper bound that limits can be checked against before any mesh exists.
#pragma once

#include <cstdint>

namespace tilelight {

inline constexpr int64_t kMenOfFullBoard = 32;

// At least as many triangles as any one piece has at this detail (segments around the axis). Smooth lathes cost their
// segments squared; the knight, nearly always the dearest, is finer than they are and grows more slowly. At
// least a quarter above today's pieces, so that modelling them better does not break the bound; a test holds it.
constexpr int64_t chess_piece_triangle_bound(int detail) {
  const int64_t d = detail;
  return 3 * d * d / 4 + 500 * d + 1'000;
}

// The board's squares and moulded frame.
inline constexpr int64_t kBoardTriangleBound = 20'000;

}  // namespace tilelight
