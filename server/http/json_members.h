// SPDX-License-Identifier: Apache-2.0
// The members of a JSON object as spans of its text, without building a tree: what a request wraps around a scene is
// taken off here, and the scene reaches its parser as it was sent, with its own lines and columns. Pure; no recursion.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tilelight::server {

struct JsonMember {
  std::string_view key;       // between its quotes, escapes as written
  std::string_view value;     // trimmed
  size_t begin = 0, end = 0;  // of the member in the text: from the key's quote to the value's end
};

// A byte order mark before it counts for nothing. Nothing if the text is not an object, its outline is broken or it has
// over 256 members; it can then only be a scene, and the scene's parser judges it. What is inside the values is not
// checked.
std::optional<std::vector<JsonMember>> scan_members(std::string_view text);

// The text with all but the named members blanked out, so that every place in it stays where it was.
std::string keep_members(std::string_view text, const std::vector<JsonMember>& members,
                         const std::vector<std::string_view>& keys);

// The text with all but one value blanked out.
std::string keep_value(std::string_view text, const JsonMember& member);

// The text with the value of a member, of which so much is known, replaced by 0.
std::string without_value(std::string_view text, const JsonMember& member);

const JsonMember* find_member(const std::vector<JsonMember>& members, std::string_view key);

// The whole number that a JSON number is: 3, 3.0 and 0.3e1 are the same.
std::optional<int64_t> json_whole_number(std::string_view value);

// "abc" -> abc; nothing for anything but a string without escapes.
std::optional<std::string_view> plain_string(std::string_view value);

}  // namespace tilelight::server
