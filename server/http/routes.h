// SPDX-License-Identifier: Apache-2.0
// The routes of the API and of the admin port, each as one table, and the way from a request to its handler.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/http/services.h"

namespace tilelight::server {

struct Route {
  std::string_view method;
  std::string_view pattern;  // "/v1/renders/{id}": {names} match one segment and become request.args in order
  Reply (*handler)(Services&, const Request&);
  // The names that its query may have, each once; openapi.json describes them.
  std::vector<std::string> query = {};
  // A query means nothing to the server and is let through: links to pages get parameters from others, and so do the
  // addresses of probes ("/livez?verbose").
  bool ignores_query = false;
};

const std::vector<Route>& api_routes();
const std::vector<Route>& admin_routes();

// Guards, finds the route, runs its handler, writes the request's log line and counts. Never throws.
Response dispatch(Services& services, const std::vector<Route>& routes, Request&& request);

}  // namespace tilelight::server
