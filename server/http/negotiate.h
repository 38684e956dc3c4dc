// SPDX-License-Identifier: Apache-2.0
// What a client prefers and what it holds: Accept (RFC 9110, 12.5.1), Prefer (RFC 7240), If-Match and If-None-Match
// (RFC 9110, 13). No resource here has a date of modification, so conditions by date are ignored, as 13.1.3 and 13.1.4
// want it. Pure.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/message.h"

namespace tilelight::server {

// The offer that the client likes best, by quality and then by the order of the offers; nothing if it accepts none.
// Without an Accept header everything is accepted.
std::optional<std::string_view> best_offer(const Request& request, const std::vector<std::string_view>& offers);

// Of the formats the one that the client asked for by name ("image/png", "image/*"), and not by "*/*" or by silence;
// nothing also where it likes application/json better.
std::optional<ImageFormat> asked_image_format(const Request& request, const std::vector<ImageFormat>& formats);

struct Preferences {
  std::optional<double> wait_s;  // wait=N; N is whole by the RFC, and tenths are understood too
  bool respond_async = false;
};
Preferences read_preferences(const Request& request);

// True if If-None-Match names the tag, so that 304 is the answer.
bool has_current(const Request& request, std::string_view etag);

// What If-Match and If-None-Match are held against: the representation that a GET of the same target would have.
struct Current {
  bool exists = true;     // false: the target knows no GET
  std::string etag = "";  // empty: it has none
};
// False where If-Match does not name it (412). A weak tag is never the same as another (RFC 9110, 8.8.3.2).
bool is_match_met(const Request& request, const Current& current);
Problem precondition_failed(const Current& current);
// precondition_failed where a request that changes something must not: by If-Match, or because If-None-Match names the
// current one.
::tl::expected<void, Problem> check_conditions(const Request& request, const Current& current);

// All values of a header as one list.
std::vector<std::string> header_list(const Request& request, std::string_view name);

// The items of a comma-separated header value, trimmed; quoted strings stay whole.
std::vector<std::string> split_list(std::string_view value);

}  // namespace tilelight::server
