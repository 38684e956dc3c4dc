// SPDX-License-Identifier: Apache-2.0
// Grammar: the scene language as one table. The parser checks documents against it, the JSON Schema is written from it,
// so neither can know a key, a range or a word that the other does not.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

#include "renderer/scene/limits.h"

namespace tilelight {

// Lengths, intensities and factors reach this far: their squares and products stay well inside a double.
inline constexpr double kMaxMagnitude = 1e30;

// What a number may be.
struct Range {
  double min = -kMaxMagnitude, max = kMaxMagnitude;
  bool above_min = false;  // min itself is refused
  bool below_max = false;  // max itself is refused
  bool nonzero = false;
  bool whole = false;
  bool is_limit = false;  // max is a limit of the server and not of the language
};

// How many entries a list or map may have.
struct Length {
  int64_t min = 0, max = std::numeric_limits<int64_t>::max();
  int64_t step = 1;       // the number of entries is a multiple of it
  bool is_limit = false;  // max is a limit of the server and not of the language
};

enum class Form : uint8_t {
  boolean,
  number,
  numbers,  // a list of numbers
  text,
  hex_color,  // "#rrggbb"
  word,       // one of a few strings
  list,       // of `options[0]`
  map,        // from names to `options[0]`
  record,     // an object of the members of `records[0]`
  tagged,     // an object of the members of that record whose name is its "type"
  any_of      // one of `options`, which differ in their JSON kinds
};

struct Record;

struct Rule {
  Form form = Form::boolean;
  Range range{};                // number; every entry of numbers
  Length length{};              // numbers, list, map; of a text what its own parser holds it to, in characters
  bool nonzero_vector = false;  // numbers: not all may be zero
  bool or_rows = false;         // numbers: also as a list of rows of Document::kRowNumbers
  bool tag_optional = false;    // tagged: without "type" it is the first record
  std::string_view pattern{};   // text: ECMA-262, of what its own parser accepts; may accept more
  std::vector<std::string_view> words{};
  std::vector<Rule> options{};
  std::vector<std::shared_ptr<const Record>> records{};
  std::string_view shared_name{};  // where the schema defines it once for all
};

enum class Need : uint8_t {
  optional,
  required,
  later  // of the language, but this release cannot do it
};

struct Field {
  std::string_view key;
  Rule rule;
  std::string_view title;
  std::string_view description{};   // with units
  std::string_view default_json{};  // what holds in its absence, where that is a constant
  Need need = Need::optional;
};

struct Record {
  std::string_view name;
  std::string_view title;
  std::vector<Field> fields;
  std::vector<std::vector<std::string_view>> exclusive{};  // the first key of each excludes the others
};

// The whole language, as one record; `Rule`s of the view's parts are its fields camera, image and render.
Record scene_grammar(const Limits& limits);

// A view on its own: camera, image, render.
Record view_grammar(const Limits& limits);

// Whether a member of this name is the user's own business, wherever it stands.
inline bool is_free_key(std::string_view key) { return key == "extras" || key.starts_with("x-"); }

}  // namespace tilelight
