// SPDX-License-Identifier: Apache-2.0
// Forsyth-Edwards notation (PGN standard, 1994, section 16.1), of which a picture needs the placement field alone, in
// the spellings of programs: with the pockets and promoted marks of crazyhouse (lichess, chessops, pychess, FICS) and
// the men of makruk (pychess).
#include <algorithm>
#include <array>

#include "renderer/base/characters.h"
#include "renderer/scene/fen.h"
#include "renderer/scene/parse.h"
#include "renderer/scene/problems.h"

namespace tilelight {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::optional<Piece> piece_of(char letter, bool is_makruk) {
  switch (lower(letter)) {
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
    case 's':  // khon
      return is_makruk ? std::optional(Piece::bishop) : std::nullopt;
    case 'm':  // met
      return is_makruk ? std::optional(Piece::queen) : std::nullopt;
    default:
      return std::nullopt;
  }
}

// S is a knight in German and Dutch: it is a man of makruk only beside an M, and where there are no men of chess.
bool is_makruk(const std::vector<std::string_view>& ranks) {
  const auto has = [&](std::string_view letters) {
    return std::any_of(ranks.begin(), ranks.end(), [letters](std::string_view rank) {
      return rank.find_first_of(letters) != std::string_view::npos;
    });
  };
  return has("mM") && !has("bBqQ");
}

class RankReader {
 public:
  explicit RankReader(bool makruk) : makruk_(makruk) {}

  // One rank, from the a file on; `number` is its name on the board. An error, or empty.
  std::string read(std::string_view text, size_t number, std::array<std::optional<ChessMan>, 8>& rank) {
    const std::string where = "rank " + std::to_string(number) + " (" + in_quotes(text) + ")";
    size_t file = 0;
    bool follows_man = false;
    for (size_t at = 0; at < text.size(); ++at) {
      while (const size_t hidden = no_width_at(text, at)) at += hidden;
      if (at == text.size()) break;
      const char c = text[at];
      const auto piece = piece_of(c, makruk_);
      if (c == '~' && follows_man) {
        has_promoted_ = true;
      } else if (c >= '1' && c <= '8') {
        file += static_cast<size_t>(c - '0');
      } else if (piece) {
        if (file < rank.size()) rank[file] = ChessMan{*piece, c == lower(c) ? Side::black : Side::white};
        ++file;
      } else {
        return "found " + character_name(character_at(text, at).code) + " in " + where + "; allowed: " + allowed(c);
      }
      follows_man = piece.has_value();
    }
    if (file == rank.size()) return "";
    return "found " + std::to_string(file) + (file == 1 ? " square in " : " squares in ") + where + "; allowed: 8";
  }

  bool has_promoted() const { return has_promoted_; }

 private:
  static std::string allowed(char refused) {
    const std::string plain = "pnbrqk, PNBRQK and 1 to 8";
    if (refused == '~') return plain + ", and '~' right behind a man, for one that was promoted";
    if (std::string_view("sSmM").find(refused) != std::string_view::npos)
      return plain + "; s and m of makruk where there is an m, and neither b nor q";
    return plain;
  }

  const bool makruk_;
  bool has_promoted_ = false;
};

}  // namespace

::tl::expected<FenPosition, std::string> parse_fen(std::string_view fen) {
  if (const size_t size = count_characters(fen); size > static_cast<size_t>(kMostFenCharacters)) {
    return ::tl::unexpected("found " + std::to_string(size) + " characters; allowed: at most " +
                            std::to_string(kMostFenCharacters) + " (limit fen_characters)");
  }
  const std::string text = unescaped_fen(fen);
  if (says_nothing(text)) return ::tl::unexpected(std::string("found an empty position; allowed: a FEN"));
  const Placement placement = find_placement(text);
  if (placement.ranks.size() != kFenRanks) return ::tl::unexpected(why_no_fen(text, placement.ranks));
  FenPosition position;
  const bool makruk = is_makruk(placement.ranks);
  RankReader reader(makruk);
  for (size_t i = 0; i < kFenRanks; ++i) {
    const size_t number = kFenRanks - i;
    std::string error = reader.read(placement.ranks[i], number, position.squares[number - 1]);
    if (!error.empty()) return ::tl::unexpected(other_board(placement.ranks).value_or(std::move(error)));
  }
  if (auto before = left_before_fen(placement.before)) position.left_out.push_back(std::move(*before));
  if (reader.has_promoted()) position.left_out.emplace_back("the marks '~' of promoted men are left out");
  if (makruk) position.left_out.emplace_back("the men S and M of makruk are drawn as bishops and queens");
  if (!placement.pocket.empty())
    position.left_out.push_back("the pocket " + in_quotes(placement.pocket) + " is left out: it stands on no square");
  if (auto behind = left_behind_fen(placement.behind)) position.left_out.push_back(std::move(*behind));
  return position;
}

}  // namespace tilelight
