// SPDX-License-Identifier: Apache-2.0
#include "server/http/guard.h"

#include <algorithm>

#include "server/http/origin.h"
#include "server/http/text.h"

namespace tilelight::server {
namespace {

std::string quoted(std::string_view text) { return "'" + std::string(text.substr(0, 100)) + "'"; }

std::string_view without_dot(std::string_view name) {
  return name.substr(0, name.size() - (!name.empty() && name.back() == '.'));  // "localhost." is localhost
}

// A rebinding attack needs a name that the attacker's DNS answers: addresses and localhost are safe from it.
bool is_own_name(std::string_view name, const Config& config) {
  name = without_dot(name);
  if (name == "localhost" || parse_address(name) || is_same_name(name, config.host)) return true;
  return std::any_of(config.allowed_hosts.begin(), config.allowed_hosts.end(),
                     [&](const std::string& allowed) { return is_same_name(name, allowed); });
}

::tl::expected<void, Problem> check_host(const Authority& host, const Config& config) {
  if (host.name.empty() || is_own_name(host.name, config)) return {};  // empty: HTTP/1.0; no browser
  return problem(
      421, "misdirected",
      "this server does not answer for the host " + quoted(host.name) + "; start it with --allowed-hosts to make it");
}

// What a browser says of the page that asks. Sec-Fetch-Site decides where it is there, whatever a proxy has made of
// Host: no script can set it, and browsers send it to https and to loopback names alone, where a name that was bound
// anew to our address fails at the certificate or at check_host. Browsers and addresses without it send Origin.
// Who sends neither is no browser.
::tl::expected<void, Problem> check_site(const Request& request) {
  const auto [site, sites_end] = request.headers.equal_range("Sec-Fetch-Site");
  const auto is_own_site = [](const auto& field) { return field.second == "same-origin" || field.second == "none"; };
  if (site != sites_end) {
    if (std::all_of(site, sites_end, is_own_site)) return {};
    return problem(403, "cross_origin",
                   "requests from pages of other sites are not accepted; the browser calls this one " +
                       quoted(std::find_if_not(site, sites_end, is_own_site)->second));
  }
  const auto origin = request.header("Origin");
  if (!origin || is_same_origin(*origin, request.host, request.scheme)) return {};
  return problem(403, "cross_origin",
                 "requests from pages of other sites are not accepted; the page is of " + quoted(*origin) +
                     ", the request for the host " + quoted(authority_text(request.host)) +
                     (request.scheme.empty() ? "" : " by " + request.scheme) +
                     ". If that is one site behind a proxy, the proxy must hand on Host as the browser sent it");
}

bool is_json(std::string_view content_type) {
  return is_same_name(trim(content_type.substr(0, content_type.find(';'))), "application/json");
}

}  // namespace

::tl::expected<void, Problem> check_guard(const Request& request, const Config& config) {
  // Both: a page may set X-Forwarded-Host, but not Host, on requests to its own name.
  const auto named = parse_authority(request.header("Host").value_or(""));
  for (const Authority& host : {named.value_or(Authority{}), request.host}) {
    if (auto own = check_host(host, config); !own) return own;
  }
  const bool changes_state = request.method != "GET" && request.method != "OPTIONS";
  if (!changes_state) return {};
  if (auto own = check_site(request); !own) return own;
  if (request.body.empty()) return {};
  const auto type = request.header("Content-Type");
  if (!type || !is_json(*type)) {
    return problem(415, "content_type",
                   "send the body as Content-Type: application/json" +
                       (type ? "; found " + std::string(type->substr(0, 100)) : std::string()));
  }
  return {};
}

}  // namespace tilelight::server
