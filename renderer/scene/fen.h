// SPDX-License-Identifier: Apache-2.0
// Where the squares are in a text that holds a chess position, and what is told of the rest: the parts that parse_fen
// is made of. Pure; any thread.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tilelight {

inline constexpr size_t kFenRanks = 8;

// Bytes of the character without width at `at`, 0 if there is none.
size_t no_width_at(std::string_view text, size_t at);
// Bytes of the blank at `at`, 0 if there is none: white space of any script, what has no width, and the underscore that
// stands for a blank in addresses.
size_t blank_at(std::string_view text, size_t at);
// Bytes of what parts words beside a blank: a quotation mark, a bracket, a comma, a colon, ..., but not that of "://".
size_t stop_at(std::string_view text, size_t at);

// The text without what encloses it in programs: "%20" is ' ' and "%2F" is '/', as in addresses, and "\/" is '/', as in
// JSON. Of what percent signs stand for, letters and digits stay as they are.
std::string unescaped_fen(std::string_view text);

// The placement field cut into its ranks, from the eighth on, and what stands around it. Parts of a text.
struct Placement {
  std::string_view before;
  std::vector<std::string_view> ranks;
  std::string_view pocket;  // "[Qp]", "/Qp", "/[Qp]", or empty
  std::string_view behind;
};

// The first words that seven slashes or more part, blanks beside slashes parting nothing. Without such: the words of
// the most slashes, with fewer than eight ranks. Addresses are none.
Placement find_placement(std::string_view text);

// Whether there is nothing but blanks, stops and the words that say that a position follows.
bool says_nothing(std::string_view text);

// Of the text before the squares, and of that behind them that is none of the other five fields of a FEN: a sentence.
std::optional<std::string> left_before_fen(std::string_view before);
std::optional<std::string> left_behind_fen(std::string_view behind);

// Why a text of these ranks, which are not eight, is none that can be drawn: a diagram, an address, a board of another
// size.
std::string why_no_fen(std::string_view text, const std::vector<std::string_view>& ranks);
// A board of another size than eight by eight, if its ranks are all of one length.
std::optional<std::string> other_board(const std::vector<std::string_view>& ranks);

// A regular expression of ECMA-262, with or without its flag u, that matches every text that parse_fen takes. It does
// not add up the squares of a rank.
std::string_view fen_pattern();

}  // namespace tilelight
