// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "renderer/base/characters.h"

namespace tilelight {
namespace {

TEST(Characters, AreReadAsTheyAreWritten) {
  for (const char32_t code : {0x0u, 0x41u, 0x7Fu, 0x80u, 0x7FFu, 0x800u, 0xFFFDu, 0x10000u, 0x10FFFFu}) {
    std::string text = "a";
    append_utf8(code, text);
    const Character character = character_at(text, 1);
    EXPECT_EQ(character.code, code);
    EXPECT_EQ(character.bytes, text.size() - 1);
    EXPECT_EQ(count_characters(text), 2u);
  }
}

// Table 3-7 of the Unicode Standard: overlong forms, surrogates, numbers too large, lone and missing trails.
TEST(Characters, ThatAreNoneAreSingleBytes) {
  for (const char* text : {"\x80", "\xC0\xAF", "\xC1\xBF", "\xE0\x80\xAF", "\xED\xA0\x80", "\xF0\x80\x80\xAF",
                           "\xF4\x90\x80\x80", "\xF8\x88", "\xFF", "\xE2\x82", "\xC3"}) {
    EXPECT_EQ(character_at(text, 0).code, kNoCharacter);
    EXPECT_EQ(character_at(text, 0).bytes, 1u);
  }
}

TEST(Messages, HoldNothingThatATerminalWouldActOnAndNothingUnseen) {
  EXPECT_EQ(visible_text("a b"), "a b");
  EXPECT_EQ(visible_text("\x1B[2J\r\n\t\x7F"), "\\u001b[2J\\r\\n\\t\\u007f");
  EXPECT_EQ(visible_text("\xC2\x9B\xC2\xA0\xE2\x80\xAE\xEF\xBB\xBF"), "\\u009b\\u00a0\\u202e\\ufeff");
  EXPECT_EQ(visible_text("\xF3\xA0\x80\xA1"), "\\U000e0021");
  EXPECT_EQ(visible_text("\xC3\xA9\xE2\x99\x9E"), "\xC3\xA9\xE2\x99\x9E");
  EXPECT_EQ(visible_text("\xFF"), "\\xff");
}

TEST(Messages, CallCharactersByTheirNames) {
  EXPECT_EQ(character_name(U'x'), "'x'");
  EXPECT_EQ(character_name(U'\n'), "a line end");
  EXPECT_EQ(character_name(U'\t'), "a tab");
  EXPECT_EQ(character_name(0xE9), "'\xC3\xA9' (U+00E9)");
  EXPECT_EQ(character_name(0xA0), "U+00A0");
  EXPECT_EQ(character_name(0x1B), "U+001B");
  EXPECT_EQ(character_name(0x202E), "U+202E");
  EXPECT_EQ(character_name(kNoCharacter), "a byte that is no UTF-8");
}

}  // namespace
}  // namespace tilelight
