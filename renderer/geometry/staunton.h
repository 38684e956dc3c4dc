// SPDX-License-Identifier: Apache-2.0
// What the six pieces share, and the maker of each. Proportions follow the Staunton pattern of 1849 as it is turned
// today: foot about 0.4 of the king's height, a concave stem, a wide collar, and the sign of the rank above it.
#pragma once

#include "renderer/geometry/chess_set.h"
#include "renderer/geometry/profile.h"

namespace tilelight {

// The foot of a piece, from the middle of its felt to the top of the plinth: a rounded base, a step, a domed plinth and
// a ring, in a width and height of their own. Ends at (stem_radius, height) of `Foot`, going up.
struct Foot {
  double radius;       // the widest
  double height;       // where the stem begins
  double stem_radius;  // there
};
Profile turned_foot(const Foot& foot, int detail);

// A half-round ring from the profile's end to (r, y).
void add_bead(Profile& profile, double r, double y);

// A wide thin disc with a rounded lip, its rim at (reach, y), from the profile's end below to r_after above it.
void add_collar(Profile& profile, double reach, double y, double thickness, double r_after);

// Smallest multiple of `of` that is no less than `detail`: columns of a piece with an `of`-fold head.
constexpr int round_up(int detail, int of) { return (detail + of - 1) / of * of; }

TriMesh make_pawn(int detail);
TriMesh make_rook(int detail);
TriMesh make_knight(int detail);
TriMesh make_bishop(int detail);
TriMesh make_queen(int detail);
TriMesh make_king(int detail);

int64_t pawn_triangles(int detail);
int64_t rook_triangles(int detail);
int64_t knight_triangles(int detail);
int64_t bishop_triangles(int detail);
int64_t queen_triangles(int detail);
int64_t king_triangles(int detail);

}  // namespace tilelight
