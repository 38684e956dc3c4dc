// SPDX-License-Identifier: Apache-2.0
// What a client prefers: Accept (RFC 9110, 12.5.1), Prefer (RFC 7240) and If-None-Match. Pure.
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
  std::optional<double> wait_s;  // wait=N
  bool respond_async = false;
};
Preferences read_preferences(const Request& request);

// True if If-None-Match names the tag, so that 304 is the answer.
bool has_current(const Request& request, std::string_view etag);

// The items of a comma-separated header value, trimmed; quoted strings stay whole.
std::vector<std::string> split_list(std::string_view value);

}  // namespace tilelight::server
