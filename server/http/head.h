// SPDX-License-Identifier: Apache-2.0
// scan_head: finds and checks the head of a request in the bytes received so far (RFC 9112), before anything else of
// the server sees it, and gives its fields to the request as they were sent. Strict where leniency lets two readers of
// the same bytes disagree about where a request ends. Pure.
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
  size_t field_bytes = 8000;      // a line of name and value, as much as proxies pass on by default
  int fields = 100;
  int64_t body_bytes = 16 << 20;
};

struct Head {
  Request request;         // method, path, segments, query and headers; Host is the target's where that names one
  size_t bytes = 0;        // in the buffer, through the empty line
  int64_t body_bytes = 0;  // that follow
  bool is_http_1_0 = false;
  bool expects_continue = false;
  bool closes = false;  // the client wants the connection closed after the answer
};

// Nothing: the head is not complete yet. A problem is answered and the connection closed, since what follows may be
// the rest of the refused request.
::tl::expected<std::optional<Head>, Problem> scan_head(std::string_view buffer, const HeadLimits& limits);

// The bytes of an empty line before a request: old clients end a body with one that they do not count (RFC 9112, 2.2).
inline size_t empty_line_bytes(std::string_view buffer) { return buffer.substr(0, 2) == "\r\n" ? 2 : 0; }

}  // namespace tilelight::server
