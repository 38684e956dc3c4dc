// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/characters.h"

#include <utf8proc.h>

#include <algorithm>
#include <cstdio>
#include <iterator>

namespace tilelight {
namespace {

std::string formatted(const char* format, unsigned value) {
  char text[16];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string escape(char32_t code) {
  if (code == U'\n') return "\\n";
  if (code == U'\r') return "\\r";
  if (code == U'\t') return "\\t";
  return formatted(code < 0x10000 ? "\\u%04x" : "\\U%08x", static_cast<unsigned>(code));
}

// As JSON has it: beyond U+FFFF a pair of surrogates.
std::string escape_json(char32_t code) {
  if (code < 0x10000) return formatted("\\u%04x", static_cast<unsigned>(code));
  return formatted("\\u%04x", 0xd800 + static_cast<unsigned>((code - 0x10000) >> 10)) +
         formatted("\\u%04x", 0xdc00 + static_cast<unsigned>(code & 0x3ff));
}

// keep(code): whether the character stays as it is. escape(code): what stands for the others.
template <class Keep, class Escape>
std::string escaped(std::string_view text, const Keep& keep, const Escape& escape) {
  std::string out;
  out.reserve(text.size());
  for (size_t at = 0; at < text.size();) {
    const auto [code, bytes] = character_at(text, at);
    if (code == kNoCharacter) {
      out += formatted("\\x%02x", static_cast<unsigned char>(text[at]));
    } else if (keep(code)) {
      out += text.substr(at, bytes);
    } else {
      out += escape(code);
    }
    at += bytes;
  }
  return out;
}

}  // namespace

Character character_at(std::string_view text, size_t at) {
  utf8proc_int32_t code = 0;
  const utf8proc_ssize_t bytes = utf8proc_iterate(reinterpret_cast<const utf8proc_uint8_t*>(text.data() + at),
                                                  static_cast<utf8proc_ssize_t>(text.size() - at), &code);
  if (bytes <= 0) return {kNoCharacter, 1};
  return {static_cast<char32_t>(code), static_cast<size_t>(bytes)};
}

void append_utf8(char32_t code, std::string& out) {
  utf8proc_uint8_t bytes[4];
  const utf8proc_ssize_t count = utf8proc_encode_char(static_cast<utf8proc_int32_t>(code), bytes);
  out.append(reinterpret_cast<const char*>(bytes), static_cast<size_t>(count));
}

size_t count_characters(std::string_view text) {
  size_t count = 0;
  for (size_t at = 0; at < text.size(); at += character_at(text, at).bytes) ++count;
  return count;
}

bool is_white_space(char32_t code) {
  if (code == kNoCharacter) return false;
  const utf8proc_property_t* const property = utf8proc_get_property(static_cast<utf8proc_int32_t>(code));
  const bool is_separator = property->category == UTF8PROC_CATEGORY_ZS || property->category == UTF8PROC_CATEGORY_ZL ||
                            property->category == UTF8PROC_CATEGORY_ZP;
  return is_separator || (code >= 0x9 && code <= 0xD) || code == 0x85;
}

bool is_shown(char32_t code) {
  const utf8proc_property_t* const property = utf8proc_get_property(static_cast<utf8proc_int32_t>(code));
  switch (property->category) {
    case UTF8PROC_CATEGORY_CC:
    case UTF8PROC_CATEGORY_CF:
    case UTF8PROC_CATEGORY_CN:
    case UTF8PROC_CATEGORY_CS:
    case UTF8PROC_CATEGORY_ZL:
    case UTF8PROC_CATEGORY_ZP:
      return false;
    default:
      return !property->ignorable;
  }
}

std::string printable(std::string_view text) { return escaped(text, is_shown, escape); }

std::string printable_lines(std::string_view text) {
  return escaped(
      text, [](char32_t code) { return code == U'\n' || is_shown(code); }, escape);
}

std::string visible_text(std::string_view text) {
  return escaped(
      text, [](char32_t code) { return code == U' ' || (is_shown(code) && !is_white_space(code)); }, escape);
}

std::string printable_json(std::string_view json) {
  // Below DEL there are only the white space between values and what JSON's own escapes have left.
  return escaped(
      json, [](char32_t code) { return code < 0x7f || is_shown(code); }, escape_json);
}

std::string character_name(char32_t code) {
  if (code == U'\n' || code == U'\r') return "a line end";
  if (code == U'\t') return "a tab";
  if (code == U' ') return "a blank";
  if (code == kNoCharacter) return "a byte that is no UTF-8";
  const std::string number = formatted("U+%04X", static_cast<unsigned>(code));
  if (is_white_space(code) || !is_shown(code)) return number;
  if (code < 0x80) return std::string("'") + static_cast<char>(code) + "'";
  std::string character;
  append_utf8(code, character);
  return "'" + character + "' (" + number + ")";
}

}  // namespace tilelight
