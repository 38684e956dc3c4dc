// SPDX-License-Identifier: Apache-2.0
// Places in a JSON text. Values do not carry their places; only errors need them, and a second scan of the text that
// follows nothing but the pointers asked for finds them all in one pass.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tilelight {

struct TextPlace {
  int line = 0, column = 0;  // 1-based, columns in characters (code points); 0 = unknown
};

// The place of the byte at `offset`; past the end of the text, the place just behind it.
TextPlace place_of_offset(std::string_view text, size_t offset);

struct PlaceRequest {
  std::string pointer;  // RFC 6901
  bool at_key = false;  // the place of the member's name instead of its value
  TextPlace place;      // filled in; stays 0 where the pointer leads nowhere. Of equal names the last is meant
};

// REQUIRES: `text` is valid JSON.
void find_places(std::string_view text, std::span<PlaceRequest> requests);

}  // namespace tilelight
