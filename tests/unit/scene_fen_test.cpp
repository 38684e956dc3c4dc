// SPDX-License-Identifier: Apache-2.0
// Chess positions as programs write and people paste them. tests/cases/documents.test.mjs has more of both.
#include <gtest/gtest.h>

#include <regex>

#include "renderer/base/characters.h"
#include "renderer/scene/fen.h"
#include "renderer/scene/parse.h"

namespace tilelight {
namespace {

const std::string kStart = "rnbqkbnr/pppppppp/8/8/8/8/PPPPPPPP/RNBQKBNR";

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

TEST(Fen, NeedsNoKings) { EXPECT_TRUE(parse_fen("8/8/8/8/8/8/8/8")); }

std::wstring wide(std::string_view text) {
  std::wstring out;
  for (size_t at = 0; at < text.size(); at += character_at(text, at).bytes)
    out += static_cast<wchar_t>(character_at(text, at).code);
  return out;
}

bool fits_pattern(std::string_view text) {
  static const std::wregex pattern(wide(fen_pattern()), std::regex::ECMAScript);
  return std::regex_search(wide(text), pattern);
}

// What holds the starting position, and a part of what is told of the rest: nothing where nothing is.
struct Spelling {
  std::string fen, left_out;
};
const Spelling kSpellings[] = {
    {kStart, ""},
    {kStart + " w KQkq - 0 1", ""},
    {"  " + kStart + "  ", ""},
    {kStart + "\n", ""},
    {kStart + "\r\nw KQkq - 0 1\r\n", ""},
    {"\xEF\xBB\xBF" + kStart, ""},
    {"\xE2\x80\x8B\t\xC2\xA0" + kStart + "\xE3\x80\x80w\xE2\x80\xA8KQkq", ""},
    {kStart + "\tw\tKQkq\t-\t0\t1", ""},
    {kStart + "_w_KQkq_-_0_1", ""},
    {"rnbqkbnr/\xE2\x80\x8Bpppppppp/8/8/\n8/8 / PPPPPPPP/RNBQKBNR w", ""},
    {kStart + " b", ""},
    {kStart + " w HAha - 0 1", ""},
    {kStart + " w GCgc - 0 2", ""},
    {kStart + " w KQkq - 0 1;", ""},
    {"\"" + kStart + " w KQkq - 0 1\",", ""},
    {"\xE2\x80\x9C" + kStart + "\xE2\x80\x9D", ""},
    {"`" + kStart + "`", ""},
    {"fen " + kStart, ""},
    {"FEN: " + kStart + " w KQkq - 0 1", ""},
    {"\"fen\": \"" + kStart + "\"", ""},
    {"fen=" + kStart, ""},
    {"position fen " + kStart + " w KQkq - 0 1", ""},
    {"setboard " + kStart, ""},
    {"position fen " + kStart + " w KQkq - 0 1 moves e2e4", "\"moves e2e4\" is left out"},
    {"[FEN \"" + kStart + " w KQkq - 0 1\"]", ""},
    {"[White \"?\"]\n[FEN \"" + kStart + " w KQkq - 0 1\"]\n\n1. e4 *",
     R"("[White "?"]\n[FEN "" is left out; "1. e4 *" is left out)"},
    {"[fen \"" + kStart + "\"]\r\n", ""},
    {"regular:" + kStart + " w KQkq - 0 1", "\"regular:\" is left out"},
    {"3check: " + kStart, "\"3check:\" is left out"},
    {"a: b: fen: c = " + kStart, "\"a: b: fen: c =\" is left out"},
    {kStart + "[] w KQkq - 0 1", "the pocket \"[]\" is left out"},
    {kStart + "[-] w KQkq - 0 1", "the pocket \"[-]\" is left out"},
    {kStart + "[Qp]", "the pocket \"[Qp]\" is left out"},
    {kStart + "/Pn w KQkq - 0 1", "the pocket \"/Pn\" is left out"},
    {kStart + "[HEhe] w", "the pocket \"[HEhe]\" is left out"},
    {kStart + "[Q,p] w", "the pocket \"[Q,p]\" is left out"},
    {kStart + "[Q2p] w", "the pocket \"[Q2p]\" is left out"},
    {kStart + "[Q p] w", "the pocket \"[Q p]\" is left out"},
    {kStart + "[Q/p]w", "the pocket \"[Q/p]\" is left out"},
    {kStart + "/[Qp] w", "the pocket \"/[Qp]\" is left out"},
    {kStart + "/Q[p] w", "the pocket \"/Q[p]\" is left out"},
    {kStart + "[Qp w - -", "\"Qp w - -\" is left out"},
    {kStart + "[Qp]x", "the pocket \"[Qp]\" is left out: it stands on no square; \"x\" is left out"},
    {kStart + "/ w KQkq - 0 1", "the pocket \"/\" is left out"},
    {kStart + "/", "the pocket \"/\" is left out"},
    {"rnbq~kbnr/pppppppp/8/8/8/8/PPPPPPPP/R~NBQKBNR~", "marks '~' of promoted men are left out"},
    {kStart + " w KQkq - 3+3 0 1", "\"3+3 0 1\" is left out"},
    {kStart + " w KQkq - bm Bc4; id \"x\";", "\"bm Bc4; id \"x\" is left out"},
    {kStart + " w KQkq - 0 1 1. e4 e5", "\"1. e4 e5\" is left out"},
    {kStart + "\n8/8/8/8/8/8/8/8 w - - 0 1", "of several positions the first is drawn"},
    {"17," + kStart + " w KQkq - 0 1", "\"17,\" is left out"},
    {"17\t" + kStart, "\"17\" is left out"},
    {"1. " + kStart, "\"1.\" is left out"},
    {"1." + kStart, "\"1.\" is left out"},
    {"17: " + kStart, "\"17:\" is left out"},
    {"17|" + kStart + "|w|KQkq|-|0|1", "\"17|\" is left out"},
    {"- " + kStart, "\"-\" is left out"},
    {"-" + kStart, "\"-\" is left out"},
    {"\xE2\x80\xA2 " + kStart, ""},
    {"// " + kStart, "\"//\" is left out"},
    {"/" + kStart, "\"/\" is left out"},
    {"> " + kStart, ""},
    {"**" + kStart + "**", "\"**\" is left out; \"**\" is left out"},
    {"loadfen " + kStart, "\"loadfen\" is left out"},
    {"crazyhouse " + kStart + "[Qp] w", "\"crazyhouse\" is left out; the pocket"},
    {"Carlsen / Caruana, 1. e4 e5, 8/8: " + kStart, "\"Carlsen / Caruana, 1. e4 e5, 8/8:\" is left out"},
    {"games/x/8.fen:" + kStart, "\"games/x/8.fen:\" is left out"},
    {"1. rnbqkbnr /\npppppppp /\n8/8/8/8/PPPPPPPP\n/RNBQKBNR\nw KQkq - 0 1", "\"1.\" is left out"},
    {"https://lichess.org/editor " + kStart, "\"https://lichess.org/editor\" is left out"},
    {"{\"fen\": \"" + kStart + "\"}", ""},
    {"{\"fen\":\"rnbqkbnr\\/pppppppp\\/8\\/8\\/8\\/8\\/PPPPPPPP\\/RNBQKBNR w KQkq - 0 1\"}", ""},
    {"{\"id\": 3, \"fen\": \"" + kStart + "\", \"moves\": []}",
     R"("{"id": 3, "fen": "" is left out; "moves" is left out)"},
    {"00008," + kStart + " b - - 0 24,f2g3 e6e7,1917,https://lichess.org/787zsVup/black#48",
     R"("00008," is left out; "f2g3 e6e7,1917,https://lichess.org/787zsV)"},
    {"(" + kStart + ")", ""},
    {"(" + kStart + " w KQkq - 0 1)", ""},
    {"<" + kStart + ">", ""},
    {"[" + kStart + "]", ""},
    {"{" + kStart + "}", ""},
    {"[" + kStart + "[Qp] w]", "the pocket \"[Qp]\" is left out"},
    {"\xEF\xBC\x88" + kStart + "\xE3\x80\x82", ""},
    {kStart + "/?color=white", "the pocket \"/\" is left out: it stands on no square; \"?color=white\" is left out"},
    {kStart + "/Pn\xE2\x80\x8B w", "the pocket \"/Pn\" is left out"},
    {kStart + ".", "\".\" is left out"},
    {"rnbq\xE2\x80\x8Bkbnr/pppp\xC2\xADpppp/8/8/8\xEF\xBB\xBF/8/PPPPPPPP/RNBQ\xE2\x80\x8BKBNR w", ""},
    {kStart + "\xE2\x80\x8Bw KQkq - 0 1", ""},
    {kStart + "\xC2\xAD"
              "b KQkq - 0 1",
     ""},
    {kStart + "%20w%20KQkq%20-%200%201", ""},
    {kStart + "+w+KQkq+-+0+1", "\"+w+KQkq+-+0+1\" is left out"},
    {"rnbqkbnr%2Fpppppppp%2f8%2F8%2F8%2F8%2FPPPPPPPP%2FRNBQKBNR%20w%20KQkq%20-%200%201", ""},
    {"fen%3D%22rnbqkbnr%2F%20pppppppp%2F8%2F8%2F8%2F8%2FPPPPPPPP%2FRNBQKBNR%22", ""},
    {"fen=" + kStart + "&color=white", "\"&color=white\" is left out"},
    {std::string(3900, 'x') + " " + kStart, "...\" is left out"},
    {kStart + " w KQkq - c0 \"" + std::string(3900, 'x') + "\";", "is left out"},
};

class Spellings : public testing::TestWithParam<Spelling> {};
TEST_P(Spellings, ShowTheSquaresAndTellOfTheRest) {
  const auto position = parse_fen(GetParam().fen);
  ASSERT_TRUE(position) << GetParam().fen << "\n" << position.error();
  EXPECT_EQ(position->squares, parse_fen(kStart)->squares) << GetParam().fen;
  std::string told;
  for (const std::string& sentence : position->left_out) told += (told.empty() ? "" : "; ") + sentence;
  EXPECT_EQ(told.empty(), GetParam().left_out.empty()) << told;
  EXPECT_NE(told.find(GetParam().left_out), std::string::npos) << told;
  EXPECT_LT(told.size(), 300u);
  if (GetParam().fen.size() < 1000) {
    EXPECT_TRUE(fits_pattern(GetParam().fen)) << GetParam().fen;
  }
}
INSTANTIATE_TEST_SUITE_P(Fen, Spellings, testing::ValuesIn(kSpellings));

TEST(Fen, TakesTheMenOfMakrukForBishopsAndQueens) {
  const auto position = parse_fen("rnsmksnr/8/pppppppp/8/8/PPPPPPPP/8/RNSKMSNR w - - 0 1");
  ASSERT_TRUE(position) << position.error();
  EXPECT_EQ(position->squares, parse_fen("rnbqkbnr/8/pppppppp/8/8/PPPPPPPP/8/RNBKQBNR")->squares);
  ASSERT_EQ(position->left_out.size(), 1u);
  EXPECT_NE(position->left_out[0].find("makruk"), std::string::npos);
}

TEST(Fen, TellsEverythingThatItLeavesOut) {
  const auto position = parse_fen("crazyhouse:Q~nb1kbnr/p3pppp/8/8/8/8/PPPP1PP1/RNBQKBqR[PPPRpn] w KQk - 0 6 ; note");
  ASSERT_TRUE(position) << position.error();
  EXPECT_EQ(position->squares, parse_fen("Qnb1kbnr/p3pppp/8/8/8/8/PPPP1PP1/RNBQKBqR")->squares);
  EXPECT_EQ(position->left_out.size(), 4u);
}

struct BadFen {
  std::string_view fen;
  std::string_view says;
  bool fits = false;  // the pattern, which does not count squares
};
class BadFens : public testing::TestWithParam<BadFen> {};
TEST_P(BadFens, SayWhatIsWrongAndWhere) {
  const auto position = parse_fen(GetParam().fen);
  ASSERT_FALSE(position) << GetParam().fen;
  EXPECT_NE(position.error().find(GetParam().says), std::string::npos) << position.error();
  EXPECT_EQ(visible_text(position.error()), position.error()) << "control characters in a message";
  EXPECT_EQ(fits_pattern(GetParam().fen), GetParam().fits) << GetParam().fen;
}
using namespace std::string_view_literals;
INSTANTIATE_TEST_SUITE_P(
    Fen, BadFens,
    testing::Values(
        BadFen{"", "empty"}, BadFen{"   ", "empty"}, BadFen{"\n\xC2\xA0_\"", "empty"}, BadFen{"fen ", "empty"},
        BadFen{"8/8/8/8/8/8/8", "found 7 ranks of 8 files"}, BadFen{"8/8/8/8/8/8/8/8/8", "found 9 ranks of 8 files"},
        BadFen{"8/8/8/8/8/8/8/8/k", "found 9 ranks"}, BadFen{"8/8/8/8/8/8/8/8/P/", "found 10 ranks"},
        BadFen{"rnbqkbnr", "found no \"/\""}, BadFen{"8 8 8 8 8 8 8 8", "found no \"/\""},
        BadFen{"see 8/8, 8/8/8", "found 3 ranks;"}, BadFen{"8/8/8/8 8/8/8/8", "found 4 ranks;"},
        BadFen{"8/8/8/9/8/8/8/8", "found '9' in rank 5"}, BadFen{"8/8/8/0/8/8/8/8", "found '0' in rank 5"},
        BadFen{"8/8/8/8/8/8/8/7", "found 7 squares in rank 1", true},
        BadFen{"8/ppppppppp/8/8/8/8/8/8", "found 9 squares in rank 7"},
        BadFen{"8/8/8/8/8/8/8/88", "found 16 squares in rank 1", true},
        BadFen{"8/8/8/8/8/8/PPPPXPPP/8", "found 'X' in rank 2"}, BadFen{"8/8/8/8//8/8/8", "found 0 squares in rank 4"},
        BadFen{"8/8/8/8/8/8/8/7\n", "found 7 squares in rank 1", true},
        BadFen{"8/8/8/8/8/8/8/7\xC3\xA9", "found '\xC3\xA9' (U+00E9) in rank 1"},
        BadFen{"8/8/8/8/8/8/8/7\x1B", "found U+001B in rank 1"},
        BadFen{"8/8/8/8/8/8/8/7\0"sv, "found U+0000 in rank 1"}, BadFen{"8/8/8/8/8/8/8/7\xFF", "no UTF-8"},
        BadFen{"\xEF\xBC\x98/8/8/8/8/8/8/8", "(U+FF18) in rank 8"},
        BadFen{"~8/8/8/8/8/8/8/8", "'~' right behind a man"}, BadFen{"8/8/8/8/8/8/8/7Q~~", "found '~' in rank 1"},
        BadFen{"8/8/8/8/8/8/8/7*", "found '*' in rank 1", true}, BadFen{"1. 8/8/8/8/8*/8/8/8", "found '*' in rank 4"},
        BadFen{"17,8/8/8/8/8/8/8/7x", "found 'x' in rank 1"}, BadFen{"x8/8/8/8/8/8/8/8", "found 'x' in rank 8"},
        BadFen{"8%2F8%2F8%2F8%2F8%2F8%2F8%2F9", "found '9' in rank 1"},
        BadFen{"8/8/8/8/8/8/8/7 and 8/8/8/8/8/8/8/8", "found 7 squares in rank 1", true},
        BadFen{"8/8/4k3/8/8/4K3/4S3/8", "s and m of makruk", true},  // a knight, in German
        BadFen{"10/10/1p2q5/p4k1pp1/P9/10/5K4/7q2 b - - 3 60", "found 8 ranks of 10 files, as in capablanca"},
        BadFen{"C2a5/4a4/3ke4/9/2eH5/1pE6/9/4E4/c2cA4/4KA3 w 60 85", "found 10 ranks of 9 files, as in xiangqi"},
        BadFen{"lnsgkgsnl/1r5b1/ppppppppp/9/9/9/PPPPPPPPP/1B5R1/LNSGKGSNL b - 1", "9 ranks of 9 files, as in shogi"},
        BadFen{"99999999999999999999/8/8/8/8/8/8/8", "found '9' in rank 8"},
        BadFen{". . r q b r k .\n. p p . b p p .\n. . . . . n . .", "found a diagram, no FEN"},
        BadFen{"r n b q k b n r\np p p p p p p p\n\n\n\n\nP P P P P P P P\nR N B Q K B N R", "found a diagram"},
        BadFen{"https://lichess.org/analysis/8/8/8/8/8/8/8/8_w_-_-_0_1", "found an address"},
        BadFen{"see https://lichess.org/editor?fen=8/8/8/8/8/8/8/8_w_-_-_0_1", "found an address"},
        BadFen{"https%3A%2F%2Flichess.org%2Feditor%2F8%2F8%2F8%2F8%2F8%2F8%2F8%2F8", "found an address"},
        BadFen{"lichess.org/analysis/standard/8/8/8/8/8/8/8/8_w_-_-_0_1", "found an address"},
        BadFen{"position startpos moves e2e4", "\"startpos\""}, BadFen{"[Event \"?\"]\n\n1. e4 *", "no tag [FEN"}));

TEST(Fen, RefusesALongOneAtOnce) {
  for (const std::string& text : {std::string(1'000'000, '/'), kStart + " c0 \"" + std::string(4096, 'x') + "\";"}) {
    const auto position = parse_fen(text);
    ASSERT_FALSE(position);
    EXPECT_LT(position.error().size(), 200u);
    EXPECT_NE(position.error().find("fen_characters"), std::string::npos) << position.error();
  }
  for (const std::string part : {"/", "8", "8/", "8 ", " /", "[", "%2F", "8/8/8/8/8/8/8/", "://", "\xC2\xAD", "+"}) {
    std::string text;
    while (text.size() + part.size() <= 4096) text += part;
    EXPECT_FALSE(parse_fen(text)) << part;
  }
}

}  // namespace
}  // namespace tilelight
