// SPDX-License-Identifier: Apache-2.0
#include "server/http/documents.h"
#include "server/http/handlers.h"

namespace tilelight::server {
namespace {

Response no_store(int status, std::string content_type, std::string body) {
  return Response{status, {{"Cache-Control", "no-store"}}, std::move(content_type), std::move(body)};
}

}  // namespace

Reply get_livez(Services&, const Request&) { return no_store(200, "text/plain; charset=utf-8", "ok\n"); }

Reply get_readyz(Services& services, const Request&) {
  if (services.is_stopping.load(std::memory_order_acquire)) return busy("stopping", "the server is stopping", 5);
  return no_store(200, "text/plain; charset=utf-8", "ok\n");
}

Reply get_metrics(Services& services, const Request&) {
  return no_store(200, "text/plain; version=0.0.4; charset=utf-8", services.metrics.prometheus_text());
}

Reply get_version(Services& services, const Request&) {
  return no_store(200, "application/json", version_document(services.pool.thread_count()));
}

}  // namespace tilelight::server
