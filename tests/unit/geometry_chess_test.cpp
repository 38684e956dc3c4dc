// SPDX-License-Identifier: Apache-2.0
// The chess set as solids: closed, outward, of sane size, the same each time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "renderer/geometry/chess_set.h"

namespace tilelight {
namespace {

constexpr std::array<Piece, kPieceKinds> kPieces{Piece::pawn,   Piece::rook,  Piece::knight,
                                                 Piece::bishop, Piece::queen, Piece::king};
constexpr std::array<const char*, kPieceKinds> kNames{"pawn", "rook", "knight", "bishop", "queen", "king"};

std::string name_of(Piece piece, int detail) {
  return std::string(kNames[static_cast<size_t>(piece)]) + " at detail " + std::to_string(detail);
}

// Divergence theorem: the sum of the signed tetrahedra to the origin.
double volume_of(const TriMesh& mesh) {
  double volume = 0.0;
  for (const auto& t : mesh.triangles)
    volume += glm::dot(mesh.positions[t[0]], glm::cross(mesh.positions[t[1]], mesh.positions[t[2]])) / 6.0;
  return volume;
}

struct Bounds {
  Vec3 min{1e9}, max{-1e9};
};
Bounds bounds_of(const TriMesh& mesh) {
  Bounds bounds;
  for (const Vec3& p : mesh.positions) {
    bounds.min = glm::min(bounds.min, p);
    bounds.max = glm::max(bounds.max, p);
  }
  return bounds;
}

// Every directed edge once and its opposite once, counted in another way than the library's.
void expect_closed(const TriMesh& mesh) {
  std::vector<std::pair<uint32_t, uint32_t>> edges;
  for (const auto& t : mesh.triangles)
    for (size_t k = 0; k < 3; ++k) edges.emplace_back(t[k], t[(k + 1) % 3]);
  std::sort(edges.begin(), edges.end());
  EXPECT_EQ(std::adjacent_find(edges.begin(), edges.end()), edges.end());
  for (const auto& [from, to] : edges)
    ASSERT_TRUE(std::binary_search(edges.begin(), edges.end(), std::pair(to, from))) << from << " -> " << to;
  EXPECT_TRUE(mesh.closed);
}

// Euler: V - E + F = 2 for a surface without holes or handles.
int64_t euler_characteristic(const TriMesh& mesh) {
  const auto faces = static_cast<int64_t>(mesh.triangles.size());
  return static_cast<int64_t>(mesh.positions.size()) - faces * 3 / 2 + faces;
}

TEST(ChessSet, EveryPieceIsOneClosedSurfaceWithoutHandles) {
  for (const Piece piece : kPieces)
    for (const int detail : {8, 9, 13, 24, 48, 97}) {
      SCOPED_TRACE(name_of(piece, detail));
      const TriMesh mesh = make_chess_piece(piece, detail);
      expect_closed(mesh);
      EXPECT_EQ(euler_characteristic(mesh), 2);
    }
}

TEST(ChessSet, TheCountOfTrianglesIsKnownBeforehand) {
  for (const Piece piece : kPieces) {
    for (const int detail : {8, 9, 10, 11, 12, 13, 15, 16, 17, 18, 19, 24, 31, 37, 48, 49, 64, 65})
      EXPECT_EQ(chess_piece_triangles(piece, detail), int64_t(make_chess_piece(piece, detail).triangles.size()))
          << name_of(piece, detail);
    EXPECT_EQ(chess_piece_triangles(piece, 131), int64_t(make_chess_piece(piece, 131).triangles.size()));
  }
}

TEST(ChessSet, TrianglesGrowFromHundredsToHundredsOfThousands) {
  for (const Piece piece : kPieces) {
    SCOPED_TRACE(name_of(piece, 0));
    EXPECT_GE(chess_piece_triangles(piece, 8), 300);
    EXPECT_LE(chess_piece_triangles(piece, 8), 1700);
    EXPECT_GE(chess_piece_triangles(piece, 48), 3'000);
    EXPECT_LE(chess_piece_triangles(piece, 48), 16'000);
    EXPECT_GE(chess_piece_triangles(piece, 512), 100'000);
    EXPECT_LE(chess_piece_triangles(piece, 512), 330'000);
    for (int detail = kMinDetail; detail < kMaxDetail; ++detail)
      EXPECT_LE(chess_piece_triangles(piece, detail), 1.3 * chess_piece_triangles(piece, detail + 1));
  }
}

TEST(ChessSet, PiecesHaveTheirHeightsStandOnTheBoardAndFitTheirSquares) {
  constexpr std::array<double, kPieceKinds> kHeights{0.95, 1.10, 1.30, 1.40, 1.65, 1.90};
  for (const Piece piece : kPieces)
    for (const int detail : {24, 48, 97}) {
      SCOPED_TRACE(name_of(piece, detail));
      const TriMesh mesh = make_chess_piece(piece, detail);
      const Bounds bounds = bounds_of(mesh);
      EXPECT_EQ(bounds.min.y, 0.0);
      EXPECT_NEAR(bounds.max.y, kHeights[static_cast<size_t>(piece)], 0.02);
      for (const Vec3& p : mesh.positions) EXPECT_LT(std::hypot(p.x, p.z), 0.42);
    }
}

TEST(ChessSet, VolumesArePositiveAndConvergeWithDetail) {
  for (const Piece piece : kPieces) {
    SCOPED_TRACE(name_of(piece, 0));
    const double coarse = volume_of(make_chess_piece(piece, 24)), medium = volume_of(make_chess_piece(piece, 48)),
                 fine = volume_of(make_chess_piece(piece, 150));
    // More than a rod of radius 0.1 as high as the pawn, less than a cylinder as wide as the foot.
    EXPECT_GT(fine, 0.03);
    EXPECT_LT(fine, 3.14159 * 0.42 * 0.42 * 1.9);
    EXPECT_LT(std::fabs(medium - fine), 0.012 * fine);
    EXPECT_LT(std::fabs(medium - fine), 0.6 * std::fabs(coarse - fine));
  }
}

TEST(ChessSet, NormalsAreUnitAndLookTheWayTheirFacetsDo) {
  for (const Piece piece : kPieces)
    for (const int detail : {8, 48, 97}) {
      SCOPED_TRACE(name_of(piece, detail));
      const TriMesh mesh = make_chess_piece(piece, detail);
      int64_t far_off = 0;
      for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& tri = mesh.triangles[t];
        const Vec3 a = mesh.positions[tri[0]], b = mesh.positions[tri[1]], c = mesh.positions[tri[2]];
        const Vec3 facet = glm::normalize(glm::cross(b - a, c - a));
        for (const Vec3& n : mesh.corner_normals[t]) {
          EXPECT_NEAR(glm::dot(n, n), 1.0, 1e-12);
          EXPECT_GT(glm::dot(n, facet), 0.0);
          far_off += glm::dot(n, facet) < 0.7;
        }
      }
      EXPECT_LT(far_off, (detail == 8 ? 0.20 : 0.03) * 3.0 * double(mesh.triangles.size()));
    }
}

// Every ring of a turned piece is a circle about the axis: a quarter turn maps the points onto themselves.
TEST(ChessSet, TheTurnedPiecesAreSymmetricAboutTheirAxis) {
  for (const Piece piece : {Piece::pawn, Piece::queen}) {
    const TriMesh mesh = make_chess_piece(piece, 48);
    const auto key = [](const Vec3& p) {
      return std::array<int64_t, 3>{std::llround(p.x * 1e9), std::llround(p.y * 1e9), std::llround(p.z * 1e9)};
    };
    std::vector<std::array<int64_t, 3>> keys;
    for (const Vec3& p : mesh.positions) keys.push_back(key(p));
    std::sort(keys.begin(), keys.end());
    for (const Vec3& p : mesh.positions) {
      const auto turned = key({p.z, p.y, -p.x});
      const auto near = std::lower_bound(keys.begin(), keys.end(),
                                         std::array<int64_t, 3>{turned[0] - 2, turned[1] - 2, turned[2] - 2});
      bool found = false;
      for (auto k = near; k != keys.end() && (*k)[0] <= turned[0] + 2 && !found; ++k)
        found = std::llabs((*k)[1] - turned[1]) <= 2 && std::llabs((*k)[2] - turned[2]) <= 2;
      ASSERT_TRUE(found) << p.x << " " << p.y << " " << p.z;
    }
  }
}

TEST(ChessSet, TheKnightIsItsOwnMirrorImageAndLooksTowardsMinusZ) {
  const TriMesh mesh = make_chess_piece(Piece::knight, 48);
  double balance = 0.0, fore = 0.0, back = 0.0;
  for (const Vec3& p : mesh.positions) {
    balance += p.x;
    if (p.y > 0.7) {  // the head reaches farther than the mane
      fore = std::max(fore, -p.z);
      back = std::max(back, p.z);
    }
  }
  EXPECT_NEAR(balance, 0.0, 1e-9);
  EXPECT_GT(fore, back + 0.05);
}

TEST(ChessSet, TheBishopsCutAndTheRooksGapsRunThroughTheSurface) {
  // Points in the middle of the cut, and of a gap, are outside; their neighbours in the wood are inside. Winding number
  // by the signed solid angles of all facets (van Oosterom and Strackee 1983).
  const auto winding = [](const TriMesh& mesh, const Vec3& q) {
    double sum = 0.0;
    for (const auto& t : mesh.triangles) {
      const Vec3 a = mesh.positions[t[0]] - q, b = mesh.positions[t[1]] - q, c = mesh.positions[t[2]] - q;
      const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
      sum += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)),
                              la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return sum / (4.0 * 3.14159265358979);
  };
  const TriMesh bishop = make_chess_piece(Piece::bishop, 48), rook = make_chess_piece(Piece::rook, 48);
  EXPECT_NEAR(winding(bishop, {0.05, 1.145 + 0.05 * 0.95, 0.0}), 0.0, 1e-6);
  EXPECT_NEAR(winding(bishop, {0.05, 1.10, 0.0}), 1.0, 1e-6);
  EXPECT_NEAR(winding(bishop, {-0.05, 1.145, 0.0}), 1.0, 1e-6);
  EXPECT_NEAR(winding(rook, {0.19, 1.05, 0.0}), 0.0, 1e-6);                            // in a gap
  EXPECT_NEAR(winding(rook, {0.19 * std::cos(0.5236), 1.05, 0.19 * 0.5}), 1.0, 1e-6);  // in a merlon
  EXPECT_NEAR(winding(rook, {0.0, 1.05, 0.0}), 0.0, 1e-6);                             // in the well
}

TEST(ChessSet, ThePawnsHeadIsABall) {
  // Between y = 0.70 and the top all points are as far from the ball's centre as the top is.
  const TriMesh mesh = make_chess_piece(Piece::pawn, 97);
  double top = 0.0, widest = 0.0;
  for (const Vec3& p : mesh.positions) {
    top = std::max(top, p.y);
    if (p.y > 0.70) widest = std::max(widest, std::hypot(p.x, p.z));
  }
  for (const Vec3& p : mesh.positions) {
    if (p.y <= 0.70) continue;
    EXPECT_NEAR(glm::length(p - Vec3(0.0, top - widest, 0.0)), widest, 2e-3);
  }
}

TEST(ChessSet, TheSameDetailGivesTheSameBits) {
  for (const Piece piece : kPieces) {
    const TriMesh a = make_chess_piece(piece, 48), b = make_chess_piece(piece, 48);
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.corner_normals, b.corner_normals);
  }
}

TEST(BoardFrame, IsAClosedRingAroundTheSquares) {
  const TriMesh mesh = make_board_frame();
  expect_closed(mesh);
  EXPECT_EQ(euler_characteristic(mesh), 0);  // a torus
  const Bounds bounds = bounds_of(mesh);
  EXPECT_NEAR(bounds.max.x, kFrameOuter, 5e-3);
  EXPECT_EQ(bounds.max.x, bounds.max.z);
  EXPECT_EQ(bounds.min.x, -bounds.max.x);
  EXPECT_EQ(bounds.min.y, -kBoardThickness - kFrameFoot);
  for (const Vec3& p : mesh.positions) EXPECT_GE(std::max(std::fabs(p.x), std::fabs(p.z)), 4.0);
  // Pappus, roughly: its section of at most 0.61 x 0.18 along a way of about 4 * 8.6.
  EXPECT_GT(volume_of(mesh), 2.5);
  EXPECT_LT(volume_of(mesh), 0.61 * 0.18 * 4 * 8.6);
}

}  // namespace
}  // namespace tilelight
