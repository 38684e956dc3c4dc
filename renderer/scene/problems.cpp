// SPDX-License-Identifier: Apache-2.0
#include "renderer/scene/problems.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "renderer/base/characters.h"
#include "renderer/scene/place.h"

namespace tilelight {
namespace {

constexpr size_t kQuotedBytes = 60;  // of a string of the document inside a message

}  // namespace

void Problems::add_at(std::string pointer, bool at_key, Complaint complaint) {
  if (full()) return;
  if (errors_.size() + 1 == kMaxErrors) {
    complaint = {"too_many_errors",
                 "more than " + std::to_string(kMaxErrors - 1) + " errors; this is the first not listed",
                 {},
                 "repair the errors listed and try again"};
  }
  errors_.push_back({std::move(pointer), std::move(complaint.code), std::move(complaint.detail),
                     std::move(complaint.allowed), std::move(complaint.hint)});
  at_key_.push_back(at_key);
}

void Problems::warn(Value value, std::string code, std::string detail) {
  if (warnings_.size() == kMaxWarnings) return;
  if (warnings_.size() + 1 == kMaxWarnings) {
    code = "too_many_warnings";
    detail = "more than " + std::to_string(kMaxWarnings - 1) + " warnings; this is the first not listed";
  }
  warnings_.push_back({value.pointer(), std::move(code), std::move(detail)});
}

SceneErrors Problems::take_errors(std::string_view text) {
  std::vector<PlaceRequest> requests;
  for (size_t i = 0; i < errors_.size(); ++i) requests.push_back({errors_[i].pointer, at_key_[i], {}});
  find_places(text, requests);
  for (size_t i = 0; i < errors_.size(); ++i) {
    errors_[i].line = requests[i].place.line;
    errors_[i].column = requests[i].place.column;
  }
  // In the order of the text, whatever found them.
  std::stable_sort(errors_.begin(), errors_.end(), [](const SceneError& a, const SceneError& b) {
    return std::pair(a.line, a.column) < std::pair(b.line, b.column);
  });
  return {SceneErrors::Kind::invalid, std::move(errors_)};
}

std::string in_quotes(std::string_view text) {
  size_t end = std::min(text.size(), kQuotedBytes);
  while (end > 0 && end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return "\"" + visible_text(text.substr(0, end)) + (end < text.size() ? "...\"" : "\"");
}

std::string number_text(double number) {
  constexpr double kLongest = 1e15;  // a size is more easily read as 100000 than as 1e+05
  char buffer[32];
  const bool is_short_whole = std::abs(number) < kLongest && std::trunc(number) == number;
  const auto result = is_short_whole ? std::to_chars(buffer, buffer + sizeof buffer, number, std::chars_format::fixed)
                                     : std::to_chars(buffer, buffer + sizeof buffer, number);
  return {buffer, result.ptr};
}

std::string describe_found(Value value) {
  const auto plural = [](size_t n, const char* noun) { return std::to_string(n) + " " + noun + (n == 1 ? "" : "s"); };
  switch (value.kind()) {
    case JsonKind::null:
      return "null";
    case JsonKind::boolean:
      return value.boolean() ? "true" : "false";
    case JsonKind::number:
      return number_text(value.number());
    case JsonKind::text:
      return in_quotes(value.text()) + " (a string)";
    case JsonKind::array:
      if (value.size() == 0) return "an empty list";
      if (value.has_rows()) return "a list of " + plural(value.size(), "list") + " of 3 numbers";
      return "a list of " + plural(value.size(), value.is_packed() ? "number" : "value");
    case JsonKind::object:
      return "an object of " + plural(value.size(), "member");
  }
  return "";
}

std::string join_words(std::span<const std::string> words) {
  std::string joined;
  for (size_t i = 0; i < words.size(); ++i) {
    if (i > 0) joined += i + 1 == words.size() ? " or " : ", ";
    joined += words[i];
  }
  return joined;
}

}  // namespace tilelight
