// SPDX-License-Identifier: Apache-2.0
#include "server/http/guard.h"

#include <arpa/inet.h>

#include <algorithm>

#include "server/http/text.h"

namespace tilelight::server {
namespace {

// "localhost:8080" -> "localhost", "[::1]:80" -> "::1".
std::string host_name(std::string_view host) {
  if (!host.empty() && host.front() == '[') return std::string(host.substr(1, host.find(']') - 1));
  return std::string(host.substr(0, host.rfind(':')));
}

bool is_address(const std::string& name) {
  unsigned char out[sizeof(in6_addr)];
  return inet_pton(AF_INET, name.c_str(), out) == 1 || inet_pton(AF_INET6, name.c_str(), out) == 1;
}

// A rebinding attack needs a name that the attacker's DNS answers: addresses and localhost are safe from it.
bool is_own_host(std::string_view host, const Config& config) {
  const std::string name = host_name(host);
  if (is_same_name(name, "localhost") || is_address(name) || is_same_name(name, config.host)) return true;
  return std::any_of(config.allowed_hosts.begin(), config.allowed_hosts.end(),
                     [&](const std::string& allowed) { return is_same_name(name, allowed); });
}

bool is_json(std::string_view content_type) {
  return is_same_name(trim(content_type.substr(0, content_type.find(';'))), "application/json");
}

}  // namespace

::tl::expected<void, Problem> check_guard(const Request& request, const Config& config) {
  const std::string_view host = request.header("Host").value_or("");
  if (!host.empty() && !is_own_host(host, config)) {
    return problem(421, "misdirected",
                   "this server does not answer for the host '" + std::string(host.substr(0, 100)) +
                       "'; start it with --allowed-hosts to make it");
  }
  const bool changes_state = request.method != "GET" && request.method != "OPTIONS";
  if (!changes_state) return {};
  if (const auto origin = request.header("Origin")) {
    const size_t scheme = origin->find("://");
    const bool is_same = scheme != std::string_view::npos && is_same_name(origin->substr(scheme + 3), host);
    if (!is_same) return problem(403, "cross_origin", "requests from pages of other sites are not accepted");
  }
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
