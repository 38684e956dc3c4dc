// SPDX-License-Identifier: Apache-2.0
// The vocabulary in which the grammar is written, and its chapters.
#pragma once

#include <array>
#include <utility>

#include "renderer/scene/grammar.h"
#include "renderer/scene/words.h"

namespace tilelight {

inline constexpr Range kAnyNumber{};
inline constexpr Range kNotNegative{.min = 0.0};
inline constexpr Range kPositive{.min = 0.0, .above_min = true};
inline constexpr Range kUnitInterval{.min = 0.0, .max = 1.0};

inline Rule boolean_rule() { return {.form = Form::boolean}; }
inline Rule text_rule() { return {.form = Form::text}; }
inline Rule number_rule(Range range) { return {.form = Form::number, .range = range}; }
inline Rule whole_rule(double min, double max, bool is_limit = false) {
  return number_rule({.min = min, .max = max, .whole = true, .is_limit = is_limit});
}
inline Rule numbers_rule(Range range, Length length) {
  return {.form = Form::numbers, .range = range, .length = length};
}
inline Rule threes_rule(Range range, Length length) {
  return {.form = Form::numbers, .range = range, .length = length, .or_rows = true};
}
inline Rule vector_rule() {
  Rule rule = numbers_rule(kAnyNumber, {3, 3});
  rule.shared_name = "vector";
  return rule;
}
inline Rule direction_rule() {
  Rule rule = numbers_rule(kAnyNumber, {3, 3});
  rule.nonzero_vector = true;
  rule.shared_name = "direction";
  return rule;
}
inline Rule any_of(std::vector<Rule> options) { return {.form = Form::any_of, .options = std::move(options)}; }
inline Rule list_of(Rule rule, Length length) {
  return {.form = Form::list, .length = length, .options = {std::move(rule)}};
}
inline Rule map_of(Rule rule, Length length) {
  return {.form = Form::map, .length = length, .options = {std::move(rule)}};
}
inline Rule record_rule(std::shared_ptr<const Record> record) {
  return {.form = Form::record, .records = {std::move(record)}};
}
inline Rule record_rule(Record record) { return record_rule(std::make_shared<const Record>(std::move(record))); }

template <class Enum, size_t n>
Rule words_rule(const std::array<NamedValue<Enum>, n>& table) {
  Rule rule{.form = Form::word};
  for (const auto& entry : table) rule.words.push_back(entry.name);
  return rule;
}

// A colour: grey, linear RGB, or sRGB in hexadecimal.
inline Rule color_rule(Range range, std::string_view shared_name) {
  Rule rule = any_of({number_rule(range), numbers_rule(range, {3, 3}), {.form = Form::hex_color}});
  rule.shared_name = shared_name;
  return rule;
}

// Chapters of the language.
std::shared_ptr<const Record> material_grammar();
Rule lights_grammar(const Limits& limits);
Rule meshes_grammar(const Limits& limits);
Rule objects_grammar(const Limits& limits, const std::shared_ptr<const Record>& material);
Rule camera_grammar();
Rule image_grammar(const Limits& limits);
Rule render_grammar(const Limits& limits);

}  // namespace tilelight
