// SPDX-License-Identifier: Apache-2.0
// The door to cpp-httplib: it reads the head of a request that has arrived whole and writes the response, both in
// memory. Sockets, bodies and limits are the front's (front.h), routing is the route table's. Any thread.
#pragma once

#include <functional>
#include <string>

#include "server/http/message.h"

namespace tilelight::server {

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

// Parses the head (complete, with its empty line), calls `handle` and writes its response. `handle` must not throw.
// Nothing if the library did not understand the head, and `handle` was not called.
std::optional<Served> serve_head(const std::string& head, bool close_after,
                                 const std::function<Response(Request&&)>& handle);

// A response to a request that was not understood; the connection is to be closed.
std::string closing_response(const Response& response);

}  // namespace tilelight::server
