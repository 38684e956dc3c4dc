// SPDX-License-Identifier: Apache-2.0
// What stands around the squares in a text that holds a chess position, and which texts do: the parts that parse_fen is
// made of. Pure; any thread.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace tilelight {

// Bytes of the blank at `at`, 0 if there is none: white space of any script, what has no width, and the underscore that
// stands for a blank in addresses.
size_t blank_at(std::string_view text, size_t at);
// Bytes of the quotation mark at `at`, 0 if there is none.
size_t quote_at(std::string_view text, size_t at);
// Bytes of what ends a field at `at` beside a blank: a quotation mark, a comma or a semicolon.
size_t stop_at(std::string_view text, size_t at);

// The text from its first rank on: without blanks, quotation marks, a label ("FEN:", "position fen"), the name of a
// variant ("horde:"), or the tags of a game (PGN) before the one named FEN. What is told of it goes into `left_out`.
::tl::expected<std::string_view, std::string> skip_before_fen(std::string_view text,
                                                              std::vector<std::string>& left_out);

// Of `rest`, which follows the squares: what is none of the other five fields of a FEN, told as a sentence.
std::optional<std::string> left_behind_fen(std::string_view rest);

// Why a text of these ranks, of which not all are ranks of chess, is none that can be drawn: a diagram, an address, a
// board of another size. `ranks`: as many as slashes part, also if they are not eight.
std::string why_no_fen(std::string_view text, const std::vector<std::string_view>& ranks);
// A board of another size than eight by eight, if its ranks are all of one length.
std::optional<std::string> other_board(const std::vector<std::string_view>& ranks);

// A regular expression of ECMA-262, with or without its flag u, that matches every text that parse_fen takes. It does
// not add up the squares of a rank.
std::string_view fen_pattern();

}  // namespace tilelight
