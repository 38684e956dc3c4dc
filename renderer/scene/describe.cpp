// SPDX-License-Identifier: Apache-2.0
#include "renderer/scene/describe.h"

#include <limits>
#include <vector>

#include "renderer/scene/problems.h"

namespace tilelight {

std::string describe_length(const Length& length, const std::string& noun) {
  constexpr int64_t kEndless = std::numeric_limits<int64_t>::max();
  if (length.min == length.max) return std::to_string(length.min) + " " + noun;
  std::string text;
  if (length.min > 0) text += "at least " + std::to_string(length.min) + " ";
  if (length.max != kEndless) {
    text += (text.empty() ? "at most " : "and at most ") + std::to_string(length.max) + " ";
    if (length.is_limit) text += "(a configured limit) ";
  }
  text += noun;
  if (length.step > 1) text += ", a multiple of " + std::to_string(length.step);
  return text;
}

std::string describe_range(const Range& range) {
  std::string text = range.whole ? "a whole number" : "a number";
  const bool unbounded_below = range.min <= -kMaxMagnitude;
  if (!unbounded_below) text += (range.above_min ? " above " : " from ") + number_text(range.min);
  text += (range.below_max ? " under " : unbounded_below ? " up to +-" : " to ") + number_text(range.max);
  if (range.is_limit) text += " (a configured limit)";
  if (range.nonzero) text += ", not 0";
  return text;
}

std::string describe_allowed(const Rule& rule) {
  switch (rule.form) {
    case Form::boolean:
      return "true or false";
    case Form::number:
      return describe_range(rule.range);
    case Form::numbers: {
      const std::string each = rule.range.max < kMaxMagnitude ? ", each " + describe_range(rule.range) : "";
      return describe_length(rule.length, "numbers") + (rule.or_rows ? " (or lists of 3)" : "") +
             (rule.nonzero_vector ? ", not all 0" : "") + each;
    }
    case Form::text:
      return "a string";
    case Form::hex_color:
      return "\"#rrggbb\"";
    case Form::word: {
      std::vector<std::string> words;
      for (const std::string_view word : rule.words) words.push_back(in_quotes(word));
      return join_words(words);
    }
    case Form::list:
      return "a list of objects";
    case Form::map:
      return "an object of named entries";
    case Form::record:
    case Form::tagged:
      return "an object";
    case Form::any_of: {
      std::vector<std::string> options;
      for (const Rule& option : rule.options) options.push_back(describe_allowed(option));
      return join_words(options);
    }
  }
  return "";
}

}  // namespace tilelight
