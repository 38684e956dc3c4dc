// SPDX-License-Identifier: Apache-2.0
#include "server/http/routes.h"

#include <algorithm>

#include "server/http/guard.h"
#include "server/http/handlers.h"

namespace tilelight::server {
namespace {

// Every route has its description in openapi.json; a test holds both together.
const std::vector<Route> kApiRoutes = {
    {"POST", "/v1/renders", post_render},
    {"GET", "/v1/renders", list_renders},
    {"GET", "/v1/renders/{id}", get_render},
    {"DELETE", "/v1/renders/{id}", delete_render},
    {"GET", "/v1/renders/{id}/image", get_render_image},
    {"GET", "/v1/renders/{id}/report", get_render_report},
    {"GET", "/v1/renders/{id}/pixel", get_render_pixel},
    {"GET", "/v1/renders/{id}/events", get_render_events},
    {"POST", "/v1/renders/{id}/refine", post_refine},
    {"POST", "/v1/scenes", post_scene},
    {"GET", "/v1/scenes/{id}", get_scene},
    {"GET", "/v1/scenes/{id}/plan", get_scene_plan},
    {"GET", "/v1/scenes/{id}/image", get_scene_image},
    {"POST", "/v1/plan", post_plan},
    {"POST", "/v1/sessions", post_session},
    {"PUT", "/v1/sessions/{id}/view", put_session_view},
    {"GET", "/v1/sessions/{id}/frame", get_session_frame},
    {"DELETE", "/v1/sessions/{id}", delete_session},
    {"GET", "/v1/limits", get_limits},
    {"GET", "/v1/schema/scene.json", get_scene_schema},
    {"GET", "/openapi.json", get_openapi},
    {"GET", "/", get_page_file},
};

const std::vector<Route> kAdminRoutes = {
    {"GET", "/livez", get_livez},
    {"GET", "/readyz", get_readyz},
    {"GET", "/metrics", get_metrics},
    {"GET", "/version", get_version},
};

// The first segment of a path that begins with /, and the rest.
std::string_view take_segment(std::string_view& path) {
  path.remove_prefix(1);
  const std::string_view segment = path.substr(0, path.find('/'));
  path.remove_prefix(segment.size());
  return segment;
}

bool match(std::string_view pattern, std::string_view path, std::vector<std::string>& args) {
  args.clear();
  while (!pattern.empty() && !path.empty()) {
    if (path.front() != '/') return false;
    const std::string_view wanted = take_segment(pattern), found = take_segment(path);
    if (!wanted.empty() && wanted.front() == '{') {
      if (found.empty()) return false;
      args.emplace_back(found);
    } else if (wanted != found) {
      return false;
    }
  }
  return pattern.empty() && path.empty();
}

struct Routed {
  Reply reply;
  std::string_view pattern = "none";  // for the metrics: bounded in number, whatever clients ask for
};

Routed route(Services& services, const std::vector<Route>& routes, Request& request) {
  if (auto guarded = check_guard(request, services.config); !guarded) return {::tl::unexpected(guarded.error())};
  std::string allow;
  for (const Route& candidate : routes) {
    if (!match(candidate.pattern, request.path, request.args)) continue;
    if (candidate.method == request.method) return {candidate.handler(services, request), candidate.pattern};
    allow += (allow.empty() ? "" : ", ") + std::string(candidate.method) + (candidate.method == "GET" ? ", HEAD" : "");
  }
  const bool has_page = &routes == &api_routes();
  if (allow.empty() && has_page && is_page_file(request.path)) {
    if (request.method == "GET") return {get_page_file(services, request), "/"};
    allow = "GET, HEAD";
  }
  if (allow.empty()) return {problem(404, "no_such_resource", "there is nothing at this path")};
  Problem refused{405, "method_not_allowed", request.method + " is not allowed here; allowed: " + allow, {}, {}};
  return {::tl::unexpected<Problem>(refused.with("Allow", allow))};
}

Routed route_guarded(Services& services, const std::vector<Route>& routes, Request& request) {
  try {
    return route(services, routes, request);
  } catch (const std::exception& bug) {
    services.log.write(LogLevel::error, "bug",
                       {{"id", request.id}, {"path", request.path}, {"what", std::string(bug.what())}});
    return {problem(500, "internal", "the server made a mistake; its log has a line with this request_id")};
  }
}

// Beside the times that a render took, if they are told: all that this request took, until its answer was ready.
void tell_total(Response& response, double ms) {
  for (auto& [name, value] : response.headers) {
    if (name != "Server-Timing") continue;
    char text[32];
    std::snprintf(text, sizeof text, ", total;dur=%.2f", ms);
    value += text;
  }
}

}  // namespace

const std::vector<Route>& api_routes() { return kApiRoutes; }
const std::vector<Route>& admin_routes() { return kAdminRoutes; }

Response dispatch(Services& services, const std::vector<Route>& routes, Request&& request) {
  const auto start = Steady::now();
  const std::string method = request.method;
  if (request.method == "HEAD") request.method = "GET";
  Routed routed = route_guarded(services, routes, request);
  Response response = routed.reply ? std::move(*routed.reply) : problem_response(routed.reply.error(), request.id);
  response.with("X-Content-Type-Options", "nosniff").with("Request-Id", request.id);
  const double ms = ms_since(start);
  tell_total(response, ms);
  services.metrics.observe_request_ms(ms);
  services.metrics.add("tilelight_http_requests_total", "route=\"" + std::string(routed.pattern) + "\",status=\"" +
                                                            std::to_string(response.status) + "\"");
  services.log.write(response.status >= 500 && response.status != 503 ? LogLevel::error : LogLevel::info, "request",
                     {{"id", request.id},
                      {"client", request.client},
                      {"method", method},
                      {"path", request.path},
                      {"status", int64_t{response.status}},
                      {"bytes", static_cast<int64_t>(response.body_bytes())},
                      {"ms", ms}});
  return response;
}

}  // namespace tilelight::server
