// SPDX-License-Identifier: Apache-2.0
// Characters of UTF-8 text, and text of others made safe to show: what a terminal, an editor or a reader's eye would
// act on instead of showing it becomes an escape. The door to utf8proc. Pure; any thread.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tilelight {

struct Character {
  char32_t code = 0;  // kNoCharacter for a byte that is no part of UTF-8
  size_t bytes = 1;
};
inline constexpr char32_t kNoCharacter = 0xFFFFFFFF;

// The character that begins at byte `at`. REQUIRES: at < text.size().
Character character_at(std::string_view text, size_t at);

// REQUIRES: code <= U+10FFFF.
void append_utf8(char32_t code, std::string& out);

size_t count_characters(std::string_view text);

// White space of any script (Unicode's property White_Space).
bool is_white_space(char32_t code);

// Not a control (C0, DEL, C1), a format character (directions, zero widths, tags), a separator of lines or paragraphs,
// ignorable by default, or without a character: Unicode's Cc, Cf, Zl, Zp, Cs, Cn and Default_Ignorable_Code_Point.
bool is_shown(char32_t code);

// The text with all that is not shown as an escape: \n, \r, \t, \uXXXX, beyond U+FFFF \UXXXXXXXX; bytes that are no
// UTF-8 as \xXX. For people: backslashes stay as they are, so that it does not read back.
std::string printable(std::string_view text);

// The same, but line feeds stay.
std::string printable_lines(std::string_view text);

// The same, but white space other than ' ' is an escape too.
std::string visible_text(std::string_view text);

// A JSON text with all that is not shown as \uXXXX: it reads back to the same values. REQUIRES: valid JSON, so that
// such characters stand within strings.
std::string printable_json(std::string_view json);

// "'x'", "'é' (U+00E9)", "a line end", "U+00A0".
std::string character_name(char32_t code);

}  // namespace tilelight
