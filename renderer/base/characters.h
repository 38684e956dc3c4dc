// SPDX-License-Identifier: Apache-2.0
// Characters of UTF-8 text, as messages name and show them: none that a terminal would act on, none that nobody can
// see. Pure; any thread.
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

// Controls, formats (zero-width, bidirectional, ...) and separators of lines: Unicode's Cc, Cf, Zl and Zp.
bool is_control_or_format(char32_t code);

// The text with every control, format and white space other than ' ' as an escape: \n, \u00a0, \xff.
std::string visible_text(std::string_view text);

// "'x'", "'é' (U+00E9)", "a line end", "U+00A0".
std::string character_name(char32_t code);

}  // namespace tilelight
