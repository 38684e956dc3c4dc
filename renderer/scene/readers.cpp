// SPDX-License-Identifier: Apache-2.0
#include "renderer/scene/readers.h"

#include <charconv>

#include "renderer/base/elementary.h"

namespace tilelight {
namespace {

double linear_from_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : elementary::pow((encoded + 0.055) / 1.055, 2.4);
}

Color color_from_hex(std::string_view text) {
  Color color;
  for (int channel = 0; channel < 3; ++channel) {
    const char* digits = text.data() + 1 + 2 * channel;
    int byte = 0;
    std::from_chars(digits, digits + 2, byte, 16);
    color[channel] = linear_from_srgb(byte / 255.0);
  }
  return color;
}

}  // namespace

double read_number(Value object, std::string_view key, double fallback) {
  const Value member = find_accepted(object, key);
  return member ? member.number() : fallback;
}

int read_int(Value object, std::string_view key, int fallback) {
  return static_cast<int>(read_number(object, key, fallback));
}

bool read_boolean(Value object, std::string_view key, bool fallback) {
  const Value member = find_accepted(object, key);
  return member ? member.boolean() : fallback;
}

std::string read_text(Value object, std::string_view key, std::string_view fallback) {
  const Value member = find_accepted(object, key);
  return std::string(member ? member.text() : fallback);
}

Vec3 read_vector(Value object, std::string_view key, const Vec3& fallback) {
  const Value member = find_accepted(object, key);
  if (!member) return fallback;
  const auto numbers = member.numbers();
  return {numbers[0], numbers[1], numbers[2]};
}

Color read_color(Value object, std::string_view key, const Color& fallback) {
  const Value member = find_accepted(object, key);
  return member ? color_of(member) : fallback;
}

Color color_of(Value value) {
  if (value.is(JsonKind::number)) return Color(value.number());
  if (value.is(JsonKind::text)) return color_from_hex(value.text());
  const auto numbers = value.numbers();
  return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace tilelight
