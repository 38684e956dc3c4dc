// SPDX-License-Identifier: Apache-2.0
#include "server/http/http_server.h"

#include "server/random_id.h"

namespace tilelight::server {
namespace {

std::string refuse(Services& services, const Problem& problem, const std::string& client) {
  const std::string id = random_hex(8);
  services.metrics.add("tilelight_http_refused_total", "status=\"" + std::to_string(problem.status) + "\"");
  services.log.write(LogLevel::info, "refused",
                     {{"id", id}, {"client", client}, {"status", int64_t{problem.status}}, {"code", problem.code}});
  return closing_response(problem_response(problem, id).with("Request-Id", id));
}

Served serve(Services& services, const std::vector<Route>& routes, const Exchange& exchange) try {
  auto served = serve_head(exchange.head, false, [&](Request&& request) {
    request.body = exchange.body;
    request.client = exchange.client;
    request.id = random_hex(8);
    request.gone = exchange.gone.get_token();
    return dispatch(services, routes, std::move(request));
  });
  if (served) return std::move(*served);
  // The front has checked the head, so this is rare; it is logged and counted like the front's own refusals.
  return {refuse(services, {400, "bad_request", "the request was not understood", {}, {}}, exchange.client), nullptr,
          true};
} catch (const std::exception& bug) {
  // Beyond what dispatch() catches: memory was short when an answer was put together. No answer, and the connection
  // closes; nothing that a request does may end the process.
  services.metrics.add("tilelight_http_refused_total", "status=\"none\"");
  services.log.write(LogLevel::error, "bug", {{"client", exchange.client}, {"what", std::string(bug.what())}});
  return {"", nullptr, true};
}

}  // namespace

Result<std::unique_ptr<HttpServer>> HttpServer::bind(FrontOptions options, const std::vector<Route>& routes,
                                                     Services& services) {
  auto front = Front::bind(
      std::move(options), [&](Exchange& exchange) { return serve(services, routes, exchange); },
      [&](const Problem& problem, const std::string& client) { return refuse(services, problem, client); });
  if (!front) return ::tl::unexpected(front.error());
  auto server = std::make_unique<HttpServer>();
  server->front_ = std::move(*front);
  return server;
}

}  // namespace tilelight::server
