// SPDX-License-Identifier: Apache-2.0
#include "renderer/geometry/chess_set.h"

#include <algorithm>
#include <array>

#include "renderer/geometry/staunton.h"

namespace tilelight {
namespace {

struct PieceMaker {
  TriMesh (*make)(int detail);
  int64_t (*triangles)(int detail);
};

// In the order of Piece.
constexpr std::array<PieceMaker, kPieceKinds> kMakers{{{make_pawn, pawn_triangles},
                                                       {make_rook, rook_triangles},
                                                       {make_knight, knight_triangles},
                                                       {make_bishop, bishop_triangles},
                                                       {make_queen, queen_triangles},
                                                       {make_king, king_triangles}}};

}  // namespace

TriMesh make_chess_piece(Piece piece, int detail) {
  return kMakers[static_cast<size_t>(piece)].make(std::clamp(detail, kMinDetail, kMaxDetail));
}

int64_t chess_piece_triangles(Piece piece, int detail) {
  return kMakers[static_cast<size_t>(piece)].triangles(std::clamp(detail, kMinDetail, kMaxDetail));
}

}  // namespace tilelight
