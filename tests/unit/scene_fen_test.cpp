// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "renderer/scene/parse.h"

namespace tilelight {
namespace {

constexpr std::string_view kStart = "rnbqkbnr/pppppppp/8/8/8/8/PPPPPPPP/RNBQKBNR";

TEST(Fen, PlacesTheStartingPosition) {
  const auto position = parse_fen(kStart);
  ASSERT_TRUE(position) << position.error();
  constexpr Piece kBackRank[] = {Piece::rook, Piece::knight, Piece::bishop, Piece::queen,
                                 Piece::king, Piece::bishop, Piece::knight, Piece::rook};
  for (size_t file = 0; file < 8; ++file) {
    EXPECT_EQ(position->squares[0][file]->piece, kBackRank[file]);
    EXPECT_EQ(position->squares[0][file]->side, Side::white);
    EXPECT_EQ(position->squares[1][file]->piece, Piece::pawn);
    EXPECT_EQ(position->squares[6][file]->side, Side::black);
    EXPECT_EQ(position->squares[7][file]->piece, kBackRank[file]);
    for (size_t rank = 2; rank < 6; ++rank) EXPECT_FALSE(position->squares[rank][file]);
  }
}

TEST(Fen, CountsDigitsAsEmptySquares) {
  const auto position = parse_fen("8/8/8/3Q4/8/8/8/k6K");
  ASSERT_TRUE(position) << position.error();
  EXPECT_EQ(position->squares[4][3]->piece, Piece::queen);  // d5
  EXPECT_EQ(position->squares[0][0]->side, Side::black);    // a1
  EXPECT_EQ(position->squares[0][7]->side, Side::white);    // h1
}

TEST(Fen, TakesTheFullRecordAndThePlacementAlone) {
  EXPECT_TRUE(parse_fen(std::string(kStart) + " w KQkq - 0 1"));
  EXPECT_TRUE(parse_fen("  " + std::string(kStart) + "  "));
}

TEST(Fen, NeedsNoKings) { EXPECT_TRUE(parse_fen("8/8/8/8/8/8/8/8")); }

struct BadFen {
  std::string_view fen;
  std::string_view says;
};
class BadFens : public testing::TestWithParam<BadFen> {};
TEST_P(BadFens, SayWhatIsWrongAndWhere) {
  const auto position = parse_fen(GetParam().fen);
  ASSERT_FALSE(position);
  EXPECT_NE(position.error().find(GetParam().says), std::string::npos) << position.error();
}
INSTANTIATE_TEST_SUITE_P(
    Fen, BadFens,
    testing::Values(BadFen{"", "empty"}, BadFen{"   ", "empty"}, BadFen{"8/8/8/8/8/8/8", "found 7 ranks"},
                    BadFen{"8/8/8/8/8/8/8/8/8", "found 9 ranks"}, BadFen{"rnbqkbnr", "found 1 rank;"},
                    BadFen{"8/8/8/9/8/8/8/8", "found '9' in rank 5"},
                    BadFen{"8/8/8/8/8/8/8/7", "found 7 squares in rank 1"},
                    BadFen{"8/ppppppppp/8/8/8/8/8/8", "found 9 squares in rank 7"},
                    BadFen{"8/8/8/8/8/8/8/88", "found 16 squares in rank 1"},
                    BadFen{"8/8/8/8/8/8/PPPPXPPP/8", "found 'X' in rank 2"},
                    BadFen{"8/8/8/8//8/8/8", "found 0 squares"}, BadFen{"8/8/8/8/8/8/8/7\n", "found '?' in rank 1"},
                    BadFen{"8/8/8/8/8/8/8/7\xC3\xA9", "found '?' in rank 1"}));

TEST(Fen, RefusesALongOneAtOnce) {
  const auto position = parse_fen(std::string(1'000'000, '/'));
  ASSERT_FALSE(position);
  EXPECT_LT(position.error().size(), 200u);
}

}  // namespace
}  // namespace tilelight
