// SPDX-License-Identifier: Apache-2.0
// HttpServer: a front, a table of routes, and the way between them.
#pragma once

#include <memory>
#include <string>

#include "server/http/front.h"
#include "server/http/routes.h"

namespace tilelight::server {

class HttpServer {
 public:
  // Binds; start() serves. `services` and `routes` must outlive it. Errors: bind.
  static Result<std::unique_ptr<HttpServer>> bind(FrontOptions options, const std::vector<Route>& routes,
                                                  Services& services);
  void start() { front_->start(); }
  void stop(double grace_ms) { front_->stop(grace_ms); }
  int port() const { return front_->port(); }
  size_t connection_count() const { return front_->connection_count(); }
  int64_t unread_bytes() const { return front_->unread_bytes(); }

 private:
  std::unique_ptr<Front> front_;
};

}  // namespace tilelight::server
