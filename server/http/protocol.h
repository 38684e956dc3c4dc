// SPDX-License-Identifier: Apache-2.0
// The door to cpp-httplib: it writes the responses, in memory. Requests do not reach it: as Debian ships it (0.11.4) it
// decodes percent signs in the values of headers, after everything that checks them; scan_head (head.h) reads them.
// Sockets, bodies and limits are the front's (front.h), routing is the route table's. Any thread.
#pragma once

#include <string>

#include "server/http/message.h"

namespace tilelight::server {

// What every response begins with, whatever comes of the request.
inline constexpr std::string_view kResponseStart = "HTTP/1.1 ";

// A response on its way to the client.
struct Served {
  std::string bytes;           // the head, and the body unless it is shared
  SharedBytes body = nullptr;  // follows the bytes
  bool close = false;          // the connection, after it
  // What follows both, asked for piece by piece; each is a chunk (RFC 9112, 7.1), or else the connection's end is its
  // end.
  std::shared_ptr<BodyStream> stream = nullptr;
  bool is_chunked = false;

  size_t size() const { return bytes.size() + (body ? body->size() : 0); }
};

// What of a request decides how its response is written.
struct ResponseForm {
  bool is_head = false;  // without its body
  bool is_http_1_0 = false;
  bool close = false;  // the connection, after it
};
Served write_response(Response&& response, ResponseForm form);

}  // namespace tilelight::server
