// SPDX-License-Identifier: Apache-2.0
#include "server/addresses.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <memory>

namespace tilelight::server {
namespace {

// As IPv6; an IPv4 address is one within it (::ffff:a.b.c.d). All zeros of another family where it is no address.
in6_addr parse(const std::string& address) {
  in6_addr out = {};
  const std::string without_scope = address.substr(0, address.find('%'));
  const std::string mapped = "::ffff:" + without_scope;
  if (inet_pton(AF_INET6, without_scope.c_str(), &out) != 1) inet_pton(AF_INET6, mapped.c_str(), &out);
  return out;
}

}  // namespace

Result<std::vector<std::string>> resolve_host(const std::string& host) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  // An empty name would be taken for none, which stands for every address.
  const int code = host.empty() ? EAI_NONAME : getaddrinfo(host.c_str(), nullptr, &hints, &found);
  if (code != 0) return fail("no_address", "no address of '" + host + "' is known: " + gai_strerror(code));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, freeaddrinfo);
  std::vector<std::string> addresses;
  for (const addrinfo* a = found; a; a = a->ai_next) {
    char text[NI_MAXHOST] = "";
    if (getnameinfo(a->ai_addr, a->ai_addrlen, text, sizeof text, nullptr, 0, NI_NUMERICHOST) != 0) continue;
    if (std::find(addresses.begin(), addresses.end(), text) == addresses.end()) addresses.emplace_back(text);
  }
  if (addresses.empty()) return fail("no_address", "'" + host + "' has no address that can be listened on");
  return addresses;
}

bool is_loopback(const std::string& address) {
  const in6_addr parsed = parse(address);
  return IN6_IS_ADDR_LOOPBACK(&parsed) || (IN6_IS_ADDR_V4MAPPED(&parsed) && parsed.s6_addr[12] == 127);
}

bool is_any_address(const std::string& address) {
  const in6_addr parsed = parse(address);
  const bool is_v4_any = IN6_IS_ADDR_V4MAPPED(&parsed) &&
                         std::all_of(parsed.s6_addr + 12, parsed.s6_addr + 16, [](uint8_t byte) { return byte == 0; });
  return IN6_IS_ADDR_UNSPECIFIED(&parsed) || is_v4_any;
}

}  // namespace tilelight::server
