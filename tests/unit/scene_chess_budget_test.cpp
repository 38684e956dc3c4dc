// SPDX-License-Identifier: Apache-2.0
// The parser's bound on what chess pieces cost against the pieces that geometry makes.
#include <gtest/gtest.h>

#include "renderer/geometry/chess_set.h"
#include "renderer/scene/chess_budget.h"

namespace tilelight {
namespace {

TEST(ChessBudget, IsNeverBelowThePieceAndNeverFarAboveTheDearest) {
  for (int detail = kMinDetail; detail <= kMaxDetail; detail += 7) {
    int64_t dearest = 0;
    for (const Piece piece : {Piece::pawn, Piece::rook, Piece::knight, Piece::bishop, Piece::queen, Piece::king}) {
      dearest = std::max(dearest, chess_piece_triangles(piece, detail));
    }
    EXPECT_GE(chess_piece_triangle_bound(detail), dearest) << "detail " << detail;
    EXPECT_LE(chess_piece_triangle_bound(detail), 4 * dearest) << "detail " << detail;
  }
}

TEST(ChessBudget, CoversTheBoard) {
  EXPECT_GE(kBoardTriangleBound, static_cast<int64_t>(make_board_frame().triangles.size()) + 12);
}

}  // namespace
}  // namespace tilelight
