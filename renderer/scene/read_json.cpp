// SPDX-License-Identifier: Apache-2.0
#include "renderer/scene/read_json.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "renderer/scene/place.h"
#include "renderer/scene/problems.h"

namespace tilelight {
namespace {

using nlohmann::json;

SceneErrors one_error(SceneErrors::Kind kind, SceneError error) { return {kind, {std::move(error)}}; }

// The library's message without its prefix ("[json.exception...] parse error at line 1, column 2: "), and without bytes
// that may be no UTF-8.
std::string readable_message(std::string_view what) {
  constexpr size_t kMostBytes = 300;
  const size_t column = what.find("column ");
  const size_t colon = what.find(": ", column == std::string_view::npos ? 0 : column);
  if (colon != std::string_view::npos) what.remove_prefix(colon + 2);
  std::string message(what.substr(0, kMostBytes));
  for (char& c : message) {
    if (static_cast<unsigned char>(c) >= 0x7F) c = '?';
  }
  return message;
}

// Receives the events of nlohmann's parser, which keeps its own nesting on the heap, and stops it at the first excess.
class Reader {
 public:
  Reader(std::string_view text, const Limits& limits)
      : text_(text), limits_(limits), builder_(static_cast<size_t>(limits.json_values)) {}

  bool null() { return counted(builder_.add(JsonKind::null, false)); }
  bool boolean(bool value) { return counted(builder_.add(JsonKind::boolean, value)); }
  bool number_integer(int64_t value) { return counted(builder_.add_number(static_cast<double>(value))); }
  bool number_unsigned(uint64_t value) { return counted(builder_.add_number(static_cast<double>(value))); }
  bool number_float(double value, const std::string&) { return counted(builder_.add_number(value)); }
  bool string(const std::string& text) { return counted(builder_.add_text(text)); }
  bool binary(json::binary_t&) { return false; }  // JSON text has none
  bool start_object(size_t) { return open(JsonKind::object); }
  bool start_array(size_t) { return open(JsonKind::array); }
  bool key(const std::string& key) {
    builder_.key(key);
    return true;
  }
  bool end_object() { return counted(builder_.close()); }
  bool end_array() { return counted(builder_.close()); }

  bool parse_error(size_t position, const std::string& token, const json::exception& error) {
    const TextPlace place = place_of_offset(text_, position > 0 ? position - 1 : 0);
    constexpr int kNumberOverflow = 406;
    if (error.id == kNumberOverflow) {
      errors_ = one_error(SceneErrors::Kind::invalid, {builder_.next_pointer(),
                                                       "out_of_range",
                                                       "found the number " + in_quotes(token) +
                                                           "; allowed: numbers that a double can hold, up to 1.8e308",
                                                       {},
                                                       "",
                                                       place.line,
                                                       place.column});
    } else {
      errors_ = one_error(SceneErrors::Kind::not_json,
                          {"", "not_json", readable_message(error.what()), {}, "", place.line, place.column});
    }
    return false;
  }

  ::tl::expected<Document, SceneErrors> take(bool accepted) {
    if (!accepted) return ::tl::unexpected(std::move(*errors_));
    return builder_.take();
  }

 private:
  bool counted(bool added) {
    if (!added) {
      refuse("more than " + std::to_string(limits_.json_values) + " values; allowed: " +
             std::to_string(limits_.json_values) + " (limit json_values; the numbers of a list do not count)");
    }
    return added;
  }

  bool open(JsonKind kind) {
    if (builder_.depth() < static_cast<size_t>(limits_.json_depth)) return counted(builder_.open(kind));
    refuse("nested deeper than " + std::to_string(limits_.json_depth) +
           " levels; allowed: " + std::to_string(limits_.json_depth) + " (limit json_depth)");
    return false;
  }

  void refuse(std::string detail) {
    errors_ = one_error(SceneErrors::Kind::too_large, {builder_.next_pointer(), "limit", std::move(detail), {}, ""});
  }

  std::string_view text_;
  const Limits& limits_;
  DocumentBuilder builder_;
  std::optional<SceneErrors> errors_;
};

}  // namespace

std::optional<SceneErrors> find_json_errors(std::string_view text, const Limits& limits) {
  auto document = read_document(text, limits);
  return document ? std::nullopt : std::optional(std::move(document.error()));
}

::tl::expected<Document, SceneErrors> read_document(std::string_view text, const Limits& limits) {
  // Nodes count bytes in 32 bits; no configuration may raise the limit beyond that.
  const auto most_bytes = std::min<uint64_t>(static_cast<uint64_t>(limits.bytes), std::numeric_limits<int32_t>::max());
  if (text.size() > most_bytes) {
    return ::tl::unexpected(
        one_error(SceneErrors::Kind::too_large, {"",
                                                 "limit",
                                                 "found " + std::to_string(text.size()) + " bytes; allowed: at most " +
                                                     std::to_string(most_bytes) + " (limit bytes)",
                                                 {},
                                                 ""}));
  }
  // The library takes it for the end of the text.
  if (const size_t nul = text.find('\0'); nul != std::string_view::npos) {
    const TextPlace place = place_of_offset(text, nul);
    return ::tl::unexpected(
        one_error(SceneErrors::Kind::not_json, {"",
                                                "not_json",
                                                "found U+0000; no JSON text has it, also behind the document",
                                                {},
                                                "",
                                                place.line,
                                                place.column}));
  }
  Reader reader(text, limits);
  const bool accepted = json::sax_parse(text.begin(), text.end(), &reader);
  return reader.take(accepted);
}

}  // namespace tilelight
