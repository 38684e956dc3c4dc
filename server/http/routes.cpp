// SPDX-License-Identifier: Apache-2.0
#include "server/http/routes.h"

#include <algorithm>

#include "server/http/guard.h"
#include "server/http/handlers.h"
#include "server/http/text.h"

namespace tilelight::server {
namespace {

// What of a view may stand in the address of a plan; read_view_query.
const std::vector<std::string> kViewQuery = {"position", "target", "up",       "fov_y_deg",
                                             "width",    "height", "exposure", "samples"};
// The same of a picture, and its format.
const std::vector<std::string> kImageQuery = [] {
  std::vector<std::string> names = kViewQuery;
  names.emplace_back("format");
  return names;
}();

// Every route has its description in openapi.json; a test holds both together.
const std::vector<Route> kApiRoutes = {
    {"POST", "/v1/renders", post_render},
    {"GET", "/v1/renders", list_renders, {"state", "limit", "after"}},
    {"GET", "/v1/renders/{id}", get_render},
    {"DELETE", "/v1/renders/{id}", delete_render},
    {"GET", "/v1/renders/{id}/image", get_render_image, {"partial", "layer"}},
    {"GET", "/v1/renders/{id}/report", get_render_report},
    {"GET", "/v1/renders/{id}/pixel", get_render_pixel, {"x", "y", "sample"}},
    {"GET", "/v1/renders/{id}/events", get_render_events},
    {"POST", "/v1/renders/{id}/refine", post_refine},
    {"POST", "/v1/scenes", post_scene},
    {"GET", "/v1/scenes/{id}", get_scene},
    {"GET", "/v1/scenes/{id}/plan", get_scene_plan, kViewQuery},
    {"GET", "/v1/scenes/{id}/image", get_scene_image, kImageQuery},
    {"POST", "/v1/plan", post_plan},
    {"POST", "/v1/sessions", post_session},
    {"PUT", "/v1/sessions/{id}/view", put_session_view},
    {"GET", "/v1/sessions/{id}/frame", get_session_frame, {"after", "layer"}},
    {"DELETE", "/v1/sessions/{id}", delete_session},
    {"GET", "/v1/limits", get_limits},
    {"GET", "/v1/schema/scene.json", get_scene_schema},
    {"GET", "/openapi.json", get_openapi},
    {"GET", "/", get_page_file, {}, true},
};

const std::vector<Route> kAdminRoutes = {
    {"GET", "/livez", get_livez, {}, true},
    {"GET", "/readyz", get_readyz, {}, true},
    {"GET", "/metrics", get_metrics, {}, true},
    {"GET", "/version", get_version, {}, true},
};

// args: the segments at the pattern's {names}.
bool match(std::string_view pattern, const std::vector<std::string>& segments, std::vector<std::string>& args) {
  args.clear();
  for (const std::string& found : segments) {
    if (pattern.empty()) return false;
    pattern.remove_prefix(1);
    const std::string_view wanted = pattern.substr(0, pattern.find('/'));
    pattern.remove_prefix(wanted.size());
    const bool is_name = !wanted.empty() && wanted.front() == '{';
    if (is_name ? found.empty() : wanted != found) return false;
    if (is_name) args.push_back(found);
  }
  return pattern.empty();
}

// A part of a JSON pointer (RFC 6901).
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return out;
}

// Every parameter of the query is one of the route's, and none comes twice.
::tl::expected<void, Problem> check_query(const Route& route, const Request& request) {
  constexpr size_t kMaxErrors = 32;  // a short request must not make a long answer
  SceneErrors errors;
  std::string known;
  for (const std::string& name : route.query) known += (known.empty() ? "" : ", ") + name;
  for (auto it = request.query.begin(); it != request.query.end(); it = request.query.upper_bound(it->first)) {
    if (route.ignores_query || errors.errors.size() == kMaxErrors) break;
    const std::string& name = it->first;
    const bool is_known = std::find(route.query.begin(), route.query.end(), name) != route.query.end();
    if (is_known && request.query.count(name) == 1) continue;
    const std::string shown = "'" + name.substr(0, 64) + "'";
    errors.errors.push_back(
        {"/" + escaped(name.substr(0, 64)), is_known ? "duplicate_key" : "unknown_key",
         is_known ? "the query parameter " + shown + " comes twice"
                  : "unknown query parameter " + shown + "; here are allowed: " + (known.empty() ? "none" : known),
         route.query, is_known ? "" : did_you_mean(name, route.query), 0, 0});
  }
  if (errors.errors.empty()) return {};
  auto refused = scene_problem(errors);
  refused.value().code = "invalid_query";
  return refused;
}

struct Routed {
  Reply reply;
  std::string_view pattern = "none";  // for the metrics: bounded in number, whatever clients ask for
};

// The methods of the routes that match; of all routes for "*". Their GETs are HEADs too.
std::string allowed_methods(const std::vector<const Route*>& matching) {
  std::vector<std::string_view> methods;
  for (const Route* route : matching) {
    if (std::find(methods.begin(), methods.end(), route->method) == methods.end()) methods.push_back(route->method);
    if (route->method == "GET" && methods.back() == "GET") methods.push_back("HEAD");
  }
  std::string allow;
  for (const std::string_view method : methods) allow += std::string(method) + ", ";
  return allow + "OPTIONS";
}

std::vector<const Route*> find_routes(const std::vector<Route>& routes, const Request& request) {
  std::vector<const Route*> matching;
  std::vector<std::string> args;
  for (const Route& route : routes) {
    if (request.path == "*" || match(route.pattern, request.segments, args)) matching.push_back(&route);
  }
  if (!matching.empty() || !is_page_file(request.segments)) return matching;
  for (const Route& route : routes) {
    if (route.pattern == "/") matching.push_back(&route);  // serves all the files of the page
  }
  return matching;
}

// What holds of a request that changes something before it does. Where the target has an {id}, whether it exists comes
// first, and the handler asks.
::tl::expected<void, Problem> check_collection_conditions(const std::vector<const Route*>& matching, const Route& route,
                                                          const Request& request) {
  if (route.method == "GET" || route.pattern.find('{') != std::string_view::npos) return {};
  const bool has_get = std::any_of(matching.begin(), matching.end(), [](const Route* r) { return r->method == "GET"; });
  return check_conditions(request, {has_get});
}

// If-Match of a GET, held against what it was going to be answered with.
Reply with_match(const Request& request, Reply reply) {
  if (!reply || !request.header("If-Match")) return reply;
  Current current;
  for (const auto& [name, value] : reply->headers) {
    if (is_same_name(name, "ETag")) current.etag = value;
  }
  if (is_match_met(request, current)) return reply;
  return ::tl::unexpected<Problem>(precondition_failed(current));
}

Routed route(Services& services, const std::vector<Route>& routes, Request& request, std::string_view sent_method) {
  if (auto guarded = check_guard(request, services.config); !guarded) return {::tl::unexpected(guarded.error())};
  const auto matching = find_routes(routes, request);
  if (matching.empty()) return {problem(404, "no_such_resource", "there is nothing at this path")};
  const std::string allow = allowed_methods(matching);
  if (request.method == "OPTIONS") return {empty_response(204).with("Allow", allow), matching[0]->pattern};
  const auto found = std::find_if(matching.begin(), matching.end(),
                                  [&](const Route* candidate) { return candidate->method == request.method; });
  if (found == matching.end()) {
    Problem refused{
        405, "method_not_allowed", std::string(sent_method) + " is not allowed here; allowed: " + allow, {}, {}};
    return {::tl::unexpected<Problem>(refused.with("Allow", allow))};
  }
  const Route& chosen = **found;
  match(chosen.pattern, request.segments, request.args);
  if (auto known = check_query(chosen, request); !known) return {::tl::unexpected(known.error()), chosen.pattern};
  if (auto met = check_collection_conditions(matching, chosen, request); !met) {
    return {::tl::unexpected(met.error()), chosen.pattern};
  }
  Reply reply = chosen.handler(services, request);
  return {chosen.method == "GET" ? with_match(request, std::move(reply)) : std::move(reply), chosen.pattern};
}

Routed route_guarded(Services& services, const std::vector<Route>& routes, Request& request,
                     std::string_view sent_method) {
  try {
    return route(services, routes, request, sent_method);
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
  Routed routed = route_guarded(services, routes, request, method);
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
