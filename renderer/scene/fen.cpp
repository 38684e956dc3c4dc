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

constexpr size_t kRanks = 8;

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

// The placement field cut into its ranks, from the eighth on, and what hangs on the last one.
struct Placement {
  std::vector<std::string_view> ranks;
  std::string_view pocket;  // "[Qp]", "/Qp", or empty
  std::string_view rest;    // behind all of it
};

size_t skip_blanks(std::string_view text, size_t at) {
  while (const size_t bytes = blank_at(text, at)) at += bytes;
  return at;
}

size_t end_of_run(std::string_view text, size_t at, bool is_last_rank) {
  while (at < text.size() && text[at] != '/' && blank_at(text, at) == 0 && stop_at(text, at) == 0 &&
         !(is_last_rank && text[at] == '['))
    ++at;
  return at;
}

// Men of a pocket behind a slash. A king is never in one: with a king it is a ninth rank.
bool is_pocket(std::string_view text) { return text.find_first_not_of("PNBRQpnbrq~-") == std::string_view::npos; }

// The ranks may be spread over lines: blanks beside a slash part nothing.
Placement cut_placement(std::string_view text) {
  Placement out;
  size_t at = 0;
  for (bool more = true; more;) {
    const bool is_last = out.ranks.size() + 1 == kRanks;
    const size_t end = end_of_run(text, at, is_last);
    out.ranks.push_back(text.substr(at, end - at));
    const size_t slash = out.ranks.size() < kRanks ? skip_blanks(text, end) : end;
    more = slash < text.size() && text[slash] == '/';
    at = more ? skip_blanks(text, slash + 1) : end;
    if (more && is_last) {
      const size_t ninth_end = end_of_run(text, slash + 1, false);
      const bool is_over = ninth_end == text.size() || text[ninth_end] != '/';
      if (is_over && is_pocket(text.substr(slash + 1, ninth_end - slash - 1))) {
        out.pocket = text.substr(slash, ninth_end - slash);
        at = ninth_end;
        more = false;
      }
    }
  }
  out.rest = text.substr(at);
  return out;
}

// Takes "[Qp]" off the rest.
::tl::expected<void, std::string> cut_bracket(Placement& placement) {
  if (!placement.rest.starts_with('[')) return {};
  const size_t end = placement.rest.find_first_not_of("PNBRQKSMpnbrqksm~-", 1);
  if (end == std::string_view::npos || placement.rest[end] != ']') {
    const bool is_open = end == std::string_view::npos || blank_at(placement.rest, end) > 0;
    const std::string found = is_open ? "no ']'" : character_name(character_at(placement.rest, end).code);
    return ::tl::unexpected("found " + found + " in the pocket behind rank 1; allowed: men and '-', as in [Qp]");
  }
  placement.pocket = placement.rest.substr(0, end + 1);
  placement.rest.remove_prefix(end + 1);
  if (placement.rest.empty() || blank_at(placement.rest, 0) > 0 || stop_at(placement.rest, 0) > 0) return {};
  return ::tl::unexpected("found " + character_name(character_at(placement.rest, 0).code) +
                          " right behind the pocket " + in_quotes(placement.pocket) + "; allowed: a blank");
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
  FenPosition position;
  const auto text = skip_before_fen(fen, position.left_out);
  if (!text) return ::tl::unexpected(text.error());
  Placement placement = cut_placement(*text);
  if (placement.ranks.size() != kRanks) return ::tl::unexpected(why_no_fen(*text, placement.ranks));
  const bool makruk = is_makruk(placement.ranks);
  RankReader reader(makruk);
  for (size_t i = 0; i < kRanks; ++i) {
    const size_t number = kRanks - i;
    std::string error = reader.read(placement.ranks[i], number, position.squares[number - 1]);
    if (!error.empty()) return ::tl::unexpected(other_board(placement.ranks).value_or(std::move(error)));
  }
  if (auto cut = cut_bracket(placement); !cut) return ::tl::unexpected(std::move(cut.error()));
  if (reader.has_promoted()) position.left_out.emplace_back("the marks '~' of promoted men are left out");
  if (makruk) position.left_out.emplace_back("the men S and M of makruk are drawn as bishops and queens");
  if (!placement.pocket.empty())
    position.left_out.push_back("the pocket " + in_quotes(placement.pocket) + " is left out: it stands on no square");
  if (auto behind = left_behind_fen(placement.rest)) position.left_out.push_back(std::move(*behind));
  return position;
}

}  // namespace tilelight
