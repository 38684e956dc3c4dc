// SPDX-License-Identifier: Apache-2.0
// scan_head: finds and checks the head of a request in the bytes received so far (RFC 9112), before anything else of
// the server sees it. Strict where leniency lets two readers of the same bytes disagree about where a request ends.
// Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "server/http/message.h"

namespace tilelight::server {

struct HeadLimits {
  size_t head_bytes = 16 << 10;
  size_t target_bytes = 4 << 10;  // path and query
  size_t field_bytes = 8000;      // a line of name and value; the HTTP library refuses 8,192 without saying why
  int fields = 100;
  int64_t body_bytes = 16 << 20;
};

struct Head {
  // For the HTTP library: the request line and the fields, less those it must not act upon.
  std::string text;
  size_t bytes = 0;        // in the buffer, through the empty line
  int64_t body_bytes = 0;  // that follow
  bool expects_continue = false;
};

// Nothing: the head is not complete yet. A problem is answered and the connection closed, since what follows may be
// the rest of the refused request.
::tl::expected<std::optional<Head>, Problem> scan_head(std::string_view buffer, const HeadLimits& limits);

}  // namespace tilelight::server
