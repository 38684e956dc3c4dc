// SPDX-License-Identifier: Apache-2.0
// Problems: gathers everything that is wrong with a document, so that its author hears it all at once.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/scene/document.h"
#include "renderer/scene/parse.h"
#include "renderer/scene/spelling.h"  // IWYU pragma: export

namespace tilelight {

// What is wrong, apart from where.
struct Complaint {
  std::string code;
  std::string detail;
  std::vector<std::string> allowed;
  std::string hint;
};

class Problems {
 public:
  void add(Value value, Complaint complaint) { add_at(value.pointer(), false, std::move(complaint)); }
  void add_key(Value member, Complaint complaint) { add_at(member.pointer(), true, std::move(complaint)); }
  // index: among the numbers of a packed array.
  void add_element(Value array, size_t index, Complaint complaint) {
    add_at(array.number_pointer(index), false, std::move(complaint));
  }
  void add_row(Value array, size_t row, Complaint complaint) {
    add_at(array.pointer() + "/" + std::to_string(row), false, std::move(complaint));
  }
  void warn(Value value, std::string code, std::string detail);

  bool any() const { return !errors_.empty(); }
  bool full() const { return errors_.size() >= kMaxErrors; }

  // The errors with their places in the text; the last one says so if there were too many to list.
  SceneErrors take_errors(std::string_view text);
  std::vector<SceneWarning> take_warnings() { return std::move(warnings_); }

 private:
  // Enough for any author, and little enough that a hostile document is not answered by gigabytes.
  static constexpr size_t kMaxErrors = 100;
  static constexpr size_t kMaxWarnings = 100;

  void add_at(std::string pointer, bool at_key, Complaint complaint);

  std::vector<SceneError> errors_;
  std::vector<bool> at_key_;
  std::vector<SceneWarning> warnings_;
};

// `text` in quotes, shortened on a character's boundary so that a message stays a message, and as visible_text has it.
std::string in_quotes(std::string_view text);

// The shortest decimal that reads back as the same double.
std::string number_text(double number);

// What was found, for a message: "3", "\"red\" (a string)", "a list of 2 numbers", ...
std::string describe_found(Value value);

// "a", "a or b", "a, b or c".
std::string join_words(std::span<const std::string> words);

}  // namespace tilelight
