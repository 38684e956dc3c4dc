// SPDX-License-Identifier: Apache-2.0
// Readers of checked documents: typed values of members, with a fallback where the member is absent or was rejected. A
// document with errors can so be read to its end for the errors that only reading finds.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "renderer/base/vec.h"
#include "renderer/scene/document.h"
#include "renderer/scene/scene.h"
#include "renderer/scene/words.h"

namespace tilelight {

// The member, unless it is absent or rejected.
inline Value find_accepted(Value object, std::string_view key) {
  const Value member = object.find(key);
  return member && !member.is_rejected() ? member : Value();
}

double read_number(Value object, std::string_view key, double fallback);
int read_int(Value object, std::string_view key, int fallback);
bool read_boolean(Value object, std::string_view key, bool fallback);
std::string read_text(Value object, std::string_view key, std::string_view fallback = {});
Vec3 read_vector(Value object, std::string_view key, const Vec3& fallback);
Color read_color(Value object, std::string_view key, const Color& fallback);

// Of a value itself: a number (grey), three numbers, or "#rrggbb" (sRGB, IEC 61966-2-1, made linear).
Color color_of(Value value);

template <class Enum, size_t n>
Enum read_word(Value object, std::string_view key, const std::array<NamedValue<Enum>, n>& table, Enum fallback) {
  const Value member = find_accepted(object, key);
  return member ? find_word(table, member.text()).value_or(fallback) : fallback;
}

}  // namespace tilelight
