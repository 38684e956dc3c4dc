// SPDX-License-Identifier: Apache-2.0
// The door to cpp-httplib: it reads the head of a request that has arrived whole and writes the response, both in
// memory. Sockets, bodies and limits are the front's (front.h), routing is the route table's. Any thread.
#pragma once

#include <functional>
#include <string>

#include "server/http/message.h"

namespace tilelight::server {

struct Served {
  std::string bytes;   // of the response
  bool close = false;  // the connection, after it
};

// Parses the head (complete, with its empty line), calls `handle` and writes its response. `handle` must not throw.
Served serve_head(const std::string& head, bool close_after, const std::function<Response(Request&&)>& handle);

// A response to a request that was not understood; the connection is to be closed.
std::string closing_response(const Response& response);

}  // namespace tilelight::server
