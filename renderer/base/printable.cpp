// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/printable.h"

#include <utf8proc.h>

#include <cstdint>
#include <cstdio>

namespace tilelight {
namespace {

bool is_shown(utf8proc_int32_t code_point) {
  const utf8proc_property_t* const property = utf8proc_get_property(code_point);
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

void put(std::string& out, const char* format, uint32_t value) {
  char text[16];
  std::snprintf(text, sizeof text, format, value);
  out += text;
}

void put_code_point(std::string& out, uint32_t code_point) {
  put(out, code_point < 0x10000 ? "\\u%04x" : "\\U%08x", code_point);
}

// As JSON has it: beyond U+FFFF a pair of surrogates.
void put_code_point_json(std::string& out, uint32_t code_point) {
  if (code_point < 0x10000) return put(out, "\\u%04x", code_point);
  put(out, "\\u%04x", 0xd800 + ((code_point - 0x10000) >> 10));
  put(out, "\\u%04x", 0xdc00 + (code_point & 0x3ff));
}

// keep(code point): whether it stays as it is. escape(out, code point) puts the others.
template <class Keep, class Escape>
std::string escaped(std::string_view text, const Keep& keep, const Escape& escape) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    utf8proc_int32_t code_point = 0;
    const utf8proc_ssize_t size = utf8proc_iterate(reinterpret_cast<const utf8proc_uint8_t*>(text.data()),
                                                   static_cast<utf8proc_ssize_t>(text.size()), &code_point);
    if (size <= 0) {
      put(out, "\\x%02x", static_cast<unsigned char>(text.front()));
    } else if (keep(code_point)) {
      out += text.substr(0, static_cast<size_t>(size));
    } else {
      escape(out, static_cast<uint32_t>(code_point));
    }
    text.remove_prefix(size <= 0 ? 1 : static_cast<size_t>(size));
  }
  return out;
}

}  // namespace

std::string printable(std::string_view text) { return escaped(text, is_shown, put_code_point); }

std::string printable_lines(std::string_view text) {
  return escaped(
      text, [](utf8proc_int32_t c) { return c == '\n' || is_shown(c); }, put_code_point);
}

std::string printable_json(std::string_view json) {
  // Below DEL there are only the white space between values and what JSON's own escapes have left.
  return escaped(
      json, [](utf8proc_int32_t c) { return c < 0x7f || is_shown(c); }, put_code_point_json);
}

}  // namespace tilelight
