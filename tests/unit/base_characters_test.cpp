// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "renderer/base/characters.h"

namespace tilelight {
namespace {

std::string utf8(char32_t c) {
  std::string out;
  append_utf8(c, out);
  return out;
}

bool is_escaped(char32_t c) { return printable("a" + utf8(c) + "b").find(utf8(c)) == std::string::npos; }

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

TEST(Printable, ControlsAndFormatsOfAllOfUnicodeAreEscaped) {
  const std::pair<char32_t, char32_t> ranges[] = {
      {0x00, 0x1f},       {0x7f, 0x9f},        // C0, DEL, C1
      {0xad, 0xad},       {0x61c, 0x61c},      // soft hyphen, Arabic letter mark
      {0x600, 0x605},     {0x6dd, 0x6dd},      // Arabic number signs: Cf
      {0x180e, 0x180e},   {0x200b, 0x200f},    // zero widths, direction marks
      {0x2028, 0x202e},   {0x2060, 0x206f},    // separators, embeddings, isolates
      {0xfeff, 0xfeff},   {0xfff9, 0xfffb},    // byte-order mark, annotations
      {0xfe00, 0xfe0f},   {0x3164, 0x3164},    // shown as nothing: variation selectors, a filler
      {0x110bd, 0x110bd}, {0x1d173, 0x1d17a},  // Kaithi number sign, musical formats
      {0xe0001, 0xe0001}, {0xe0020, 0xe007f},  // tags
      {0xfdd0, 0xfdef},   {0xfffe, 0xffff},    // no characters
      {0x378, 0x379},     {0x10ffff, 0x10ffff}};
  for (const auto& [first, last] : ranges)
    for (char32_t c = first; c <= last; ++c) EXPECT_TRUE(is_escaped(c)) << std::hex << static_cast<uint32_t>(c);
}

TEST(Printable, WhatShowsStays) {
  for (const char* text : {"", "plain ASCII ~ \\ \" '", "Grüße, Привет, 你好, שלום, مرحبا", "µ → ∞ €", "😀"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, EscapesNameTheCodePointOrTheByte) {
  EXPECT_EQ(printable("\x1b[31m\x7f\n"), "\\u001b[31m\\u007f\\n");
  EXPECT_EQ(printable(utf8(0x9b) + utf8(0x202e) + utf8(0xe0041)), "\\u009b\\u202e\\U000e0041");
  EXPECT_EQ(printable(std::string("\0", 1)), "\\u0000");
  // Not UTF-8: a lone byte, a cut character, an overlong slash, a surrogate, beyond Unicode.
  EXPECT_EQ(printable("\x9b\xe2\x80"), "\\x9b\\xe2\\x80");
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
  EXPECT_EQ(printable_lines("a\nb\r\n"), "a\nb\\r\n");
}

TEST(Printable, JsonReadsBackToTheSame) {
  EXPECT_EQ(printable_json("{\n \"a\": \"" + utf8(0x9b) + utf8(0x202e) + utf8(0xe9) + "\x7f\"}"),
            "{\n \"a\": \"\\u009b\\u202e" + utf8(0xe9) + "\\u007f\"}");
  EXPECT_EQ(printable_json("\"" + utf8(0xe0041) + utf8(0x1f600) + "\""), "\"\\udb40\\udc41" + utf8(0x1f600) + "\"");
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
