// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/characters.h"

#include <algorithm>
#include <cstdio>
#include <iterator>

namespace tilelight {
namespace {

struct CodeRange {
  char32_t first, last;
};

bool is_in(const auto& ranges, char32_t code) {
  return std::any_of(std::begin(ranges), std::end(ranges),
                     [code](const CodeRange& range) { return code >= range.first && code <= range.last; });
}

template <class... Numbers>
std::string formatted(const char* format, Numbers... numbers) {
  char text[24];
  std::snprintf(text, sizeof text, format, numbers...);
  return text;
}

std::string escape(char32_t code) {
  if (code == U'\n') return "\\n";
  if (code == U'\r') return "\\r";
  if (code == U'\t') return "\\t";
  return formatted(code > 0xFFFF ? "\\u{%x}" : "\\u%04x", static_cast<unsigned>(code));
}

}  // namespace

// The Unicode Standard, table 3-7: no overlong forms, no surrogates, nothing over U+10FFFF.
Character character_at(std::string_view text, size_t at) {
  const auto byte = [text](size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : static_cast<unsigned char>(0);
  };
  const unsigned lead = byte(at);
  if (lead < 0x80) return {lead, 1};
  const size_t bytes = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4) return {kNoCharacter, 1};
  char32_t code = lead & (0x7F >> bytes);
  for (size_t i = 1; i < bytes; ++i) {
    if ((byte(at + i) & 0xC0) != 0x80) return {kNoCharacter, 1};
    code = code << 6 | (byte(at + i) & 0x3F);
  }
  const bool is_overlong = code < (bytes == 4 ? 0x10000u : bytes == 3 ? 0x800u : 0x80u);
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (is_overlong || is_surrogate || code > 0x10FFFF) return {kNoCharacter, 1};
  return {code, bytes};
}

void append_utf8(char32_t code, std::string& out) {
  if (code < 0x80) {
    out += static_cast<char>(code);
  } else if (code < 0x800) {
    out += static_cast<char>(0xC0 | code >> 6);
    out += static_cast<char>(0x80 | (code & 0x3F));
  } else if (code < 0x10000) {
    out += static_cast<char>(0xE0 | code >> 12);
    out += static_cast<char>(0x80 | (code >> 6 & 0x3F));
    out += static_cast<char>(0x80 | (code & 0x3F));
  } else {
    out += static_cast<char>(0xF0 | code >> 18);
    out += static_cast<char>(0x80 | (code >> 12 & 0x3F));
    out += static_cast<char>(0x80 | (code >> 6 & 0x3F));
    out += static_cast<char>(0x80 | (code & 0x3F));
  }
}

size_t count_characters(std::string_view text) {
  size_t count = 0;
  for (size_t at = 0; at < text.size(); at += character_at(text, at).bytes) ++count;
  return count;
}

// Unicode 15, PropList.txt.
bool is_white_space(char32_t code) {
  static constexpr CodeRange kRanges[] = {{0x9, 0xD},       {0x20, 0x20},     {0x85, 0x85},     {0xA0, 0xA0},
                                          {0x1680, 0x1680}, {0x2000, 0x200A}, {0x2028, 0x2029}, {0x202F, 0x202F},
                                          {0x205F, 0x205F}, {0x3000, 0x3000}};
  return is_in(kRanges, code);
}

// Unicode 15, DerivedGeneralCategory.txt.
bool is_control_or_format(char32_t code) {
  static constexpr CodeRange kRanges[] = {
      {0x0, 0x1F},        {0x7F, 0x9F},       {0xAD, 0xAD},       {0x600, 0x605},     {0x61C, 0x61C},
      {0x6DD, 0x6DD},     {0x70F, 0x70F},     {0x890, 0x891},     {0x8E2, 0x8E2},     {0x180E, 0x180E},
      {0x200B, 0x200F},   {0x2028, 0x202E},   {0x2060, 0x2064},   {0x2066, 0x206F},   {0xFEFF, 0xFEFF},
      {0xFFF9, 0xFFFB},   {0x110BD, 0x110BD}, {0x110CD, 0x110CD}, {0x13430, 0x1343F}, {0x1BCA0, 0x1BCA3},
      {0x1D173, 0x1D17A}, {0xE0001, 0xE0001}, {0xE0020, 0xE007F}};
  return is_in(kRanges, code);
}

std::string visible_text(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (size_t at = 0; at < text.size();) {
    const auto [code, bytes] = character_at(text, at);
    if (code == kNoCharacter) {
      out += formatted("\\x%02x", static_cast<unsigned>(static_cast<unsigned char>(text[at])));
    } else if (code != U' ' && (is_white_space(code) || is_control_or_format(code))) {
      out += escape(code);
    } else {
      out += text.substr(at, bytes);
    }
    at += bytes;
  }
  return out;
}

std::string character_name(char32_t code) {
  if (code == U'\n' || code == U'\r') return "a line end";
  if (code == U'\t') return "a tab";
  if (code == U' ') return "a blank";
  if (code == kNoCharacter) return "a byte that is no UTF-8";
  const std::string number = formatted("U+%04X", static_cast<unsigned>(code));
  if (is_white_space(code) || is_control_or_format(code)) return number;
  if (code < 0x80) return std::string("'") + static_cast<char>(code) + "'";
  std::string character;
  append_utf8(code, character);
  return "'" + character + "' (" + number + ")";
}

}  // namespace tilelight
