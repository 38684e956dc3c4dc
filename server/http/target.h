// SPDX-License-Identifier: Apache-2.0
// The target of a request (RFC 9112, 3.2) and its parts (RFC 3986). They are cut at their separators first and decoded
// afterwards, once: an encoded separator is data (2.2). Pure.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/message.h"

namespace tilelight::server {

// As sent: nothing is decoded yet.
struct Target {
  std::string_view authority;  // of the absolute form; empty: the Host header says it
  std::string_view path;       // begins with /, or is * (OPTIONS alone)
  std::string_view query;      // what follows the first ?
};
// Origin, absolute and asterisk form. Problems: bad_request.
::tl::expected<Target, Problem> split_target(std::string_view method, std::string_view text);

// "/a/b%2Fc" -> "a", "b/c". Nothing where a % is not followed by two hexadecimal digits.
std::optional<std::vector<std::string>> path_segments(std::string_view path);

// "a=1&b=x+y" -> a: "1", b: "x y", as forms spell it (a + is a blank, %2B is a +). Nothing likewise.
std::optional<std::multimap<std::string, std::string>> query_parameters(std::string_view query);

}  // namespace tilelight::server
