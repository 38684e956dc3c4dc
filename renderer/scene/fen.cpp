// SPDX-License-Identifier: Apache-2.0
// Forsyth-Edwards notation (PGN standard, 1994, section 16.1), of which a picture needs the placement field alone.
#include <cctype>

#include "renderer/scene/parse.h"
#include "renderer/scene/problems.h"

namespace tilelight {
namespace {

constexpr size_t kLongestFen = 128;  // eight ranks of eight men and the other five fields take under 100

std::optional<Piece> piece_of(char letter) {
  switch (std::tolower(static_cast<unsigned char>(letter))) {
    case 'p':
      return Piece::pawn;
    case 'r':
      return Piece::rook;
    case 'n':
      return Piece::knight;
    case 'b':
      return Piece::bishop;
    case 'q':
      return Piece::queen;
    case 'k':
      return Piece::king;
    default:
      return std::nullopt;
  }
}

using Rank = std::array<std::optional<ChessMan>, 8>;

// One rank, from the a file on; `number` is its name on the board.
::tl::expected<Rank, std::string> parse_rank(std::string_view text, int number) {
  const std::string where = "rank " + std::to_string(number) + " (" + in_quotes(text) + ")";
  Rank rank;
  size_t file = 0;
  for (const char c : text) {
    if (c >= '1' && c <= '8') {
      file += static_cast<size_t>(c - '0');
    } else if (const auto piece = piece_of(c)) {
      const bool is_white = std::isupper(static_cast<unsigned char>(c)) != 0;
      if (file < rank.size()) rank[file] = ChessMan{*piece, is_white ? Side::white : Side::black};
      ++file;
    } else {
      return ::tl::unexpected("found '" + std::string(1, c > ' ' && c < 127 ? c : '?') + "' in " + where +
                              "; allowed: pnbrqk, PNBRQK and 1 to 8");
    }
  }
  if (file == rank.size()) return rank;
  return ::tl::unexpected("found " + std::to_string(file) + " squares in " + where + "; allowed: 8");
}

}  // namespace

::tl::expected<ChessPositionShape, std::string> parse_fen(std::string_view fen) {
  if (fen.size() > kLongestFen) {
    return ::tl::unexpected("found " + std::to_string(fen.size()) + " characters; allowed: at most " +
                            std::to_string(kLongestFen));
  }
  const size_t begin = fen.find_first_not_of(' ');
  if (begin == std::string_view::npos) return ::tl::unexpected(std::string("found an empty position; allowed: a FEN"));
  std::string_view placement = fen.substr(begin);
  placement = placement.substr(0, placement.find(' '));
  ChessPositionShape position;
  size_t ranks = 1;
  for (const char c : placement) ranks += c == '/' ? 1 : 0;
  if (ranks != position.squares.size()) {
    return ::tl::unexpected("found " + std::to_string(ranks) + (ranks == 1 ? " rank" : " ranks") +
                            "; allowed: 8, from the eighth to the first, divided by \"/\"");
  }
  for (int number = 8; number >= 1; --number) {
    const size_t end = placement.find('/');
    auto rank = parse_rank(placement.substr(0, end), number);
    if (!rank) return ::tl::unexpected(std::move(rank.error()));
    position.squares[static_cast<size_t>(number - 1)] = *rank;
    if (end != std::string_view::npos) placement.remove_prefix(end + 1);
  }
  return position;
}

}  // namespace tilelight
