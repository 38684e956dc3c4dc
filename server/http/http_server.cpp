// SPDX-License-Identifier: Apache-2.0
#include "server/http/http_server.h"

#include "server/http/forwarded.h"
#include "server/random_id.h"

namespace tilelight::server {
namespace {

constexpr std::string_view kRefused = "tilelight_http_refused_total", kUnanswered = "status=\"none\"";

Served refuse(Services& services, const Problem& problem, const std::string& client, bool is_head) {
  const std::string id = random_hex(8);
  services.metrics.add(kRefused, "status=\"" + std::to_string(problem.status) + "\"");
  services.log.write(LogLevel::info, "refused",
                     {{"id", id}, {"client", client}, {"status", int64_t{problem.status}}, {"code", problem.code}});
  return write_response(std::move(problem_response(problem, id).with("Request-Id", id)),
                        {.is_head = is_head, .is_http_1_0 = false, .close = true});
}

Served serve(Services& services, const std::vector<Route>& routes, Exchange& exchange) try {
  Head& head = exchange.head;
  Request& request = head.request;
  const ResponseForm form{request.method == "HEAD", head.is_http_1_0, head.closes};
  request.body = exchange.body;
  request.client = exchange.client;
  believe_proxies(request, services.config.trusted_proxies);
  request.id = random_hex(8);
  request.gone = exchange.gone.get_token();
  return write_response(dispatch(services, routes, std::move(request)), form);
} catch (const std::exception&) {
  // Beyond what dispatch() catches: memory was short when an answer was put together. No answer, and the connection
  // closes; nothing that a request does may end the process, so nothing here takes memory.
  services.metrics.add(kRefused, kUnanswered);
  services.log.write(LogLevel::error, "unanswered", {});
  return {"", nullptr, true};
}

}  // namespace

Result<std::unique_ptr<HttpServer>> HttpServer::bind(FrontOptions options, const std::vector<Route>& routes,
                                                     Services& services) {
  auto front = Front::bind(
      std::move(options), [&](Exchange& exchange) { return serve(services, routes, exchange); },
      [&](const Problem& problem, const std::string& client, bool is_head) {
        return refuse(services, problem, client, is_head);
      });
  if (!front) return ::tl::unexpected(front.error());
  services.metrics.add(kRefused, kUnanswered, 0.0);  // known from here on, so that adding to it takes no memory
  auto server = std::make_unique<HttpServer>();
  server->front_ = std::move(*front);
  return server;
}

}  // namespace tilelight::server
