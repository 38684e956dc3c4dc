// SPDX-License-Identifier: Apache-2.0
// The chess set: six pieces in the Staunton manner and a framed board, made by the program. Object space: the middle
// of a piece's foot at the origin, +Y up, the king 1.9 high, a square 1 unit. White's knights look towards -z.
#pragma once

#include <memory>

#include "renderer/geometry/tri_mesh.h"

namespace tilelight {

inline constexpr int kMinDetail = 8, kMaxDetail = 512;

// One closed surface with outward normals; `detail` = segments around the axis, kMinDetail..kMaxDetail (clamped),
// rounded up where a head needs it: to a multiple of 18 for the rook's gaps, of 16 for the queen's scallops. The same
// detail gives the same bits on every CPU. Cost grows with about the power 1.5 of detail: 500 to 1,500 triangles at 8,
// 5,000 to 15,000 at 48, 150,000 to 320,000 at 512.
TriMesh make_chess_piece(Piece piece, int detail);

// The number of triangles make_chess_piece would make, without making them (for limits); exact, microseconds.
int64_t chess_piece_triangles(Piece piece, int detail);

// The 64 squares are a box from y = -kBoardThickness to 0. The frame is the moulded wood around it, a closed mesh with
// mitred corners from |x|, |z| = 4 to kFrameOuter; it stands on a recessed foot kFrameFoot below the squares' box.
inline constexpr double kBoardThickness = 0.12, kFrameFoot = 0.03, kFrameOuter = 4.61;
TriMesh make_board_frame();

}  // namespace tilelight
