// SPDX-License-Identifier: Apache-2.0
#include "server/http/forwarded.h"

#include <cctype>

#include "server/http/negotiate.h"
#include "server/http/origin.h"
#include "server/http/text.h"

namespace tilelight::server {
namespace {

bool is_trusted(const Address& address, const std::vector<Network>& trusted) {
  return std::any_of(trusted.begin(), trusted.end(), [&](const Network& network) { return network.holds(address); });
}

// All values of a field, from right to left: the last proxy's first.
std::vector<std::string> values_from_right(const Request& request, std::string_view name) {
  std::vector<std::string> out;
  const auto [first, last] = request.headers.equal_range(name);
  for (auto it = first; it != last; ++it) {
    for (auto& item : split_list(it->second)) out.push_back(std::move(item));
  }
  std::reverse(out.begin(), out.end());
  return out;
}

// "192.0.2.1", "192.0.2.1:4711", "2001:db8::1", "[2001:db8::1]", "[2001:db8::1]:4711".
std::optional<Address> parse_hop(std::string_view text) {
  if (const auto address = parse_address(text)) return address;
  const auto authority = parse_authority(text);
  return authority ? parse_address(authority->name) : std::nullopt;
}

// The field's value `place` places from the right.
std::string value_at(const Request& request, std::string_view name, size_t place) {
  const auto values = values_from_right(request, name);
  return values.empty() ? "" : values[std::min(place, values.size() - 1)];
}

// "/render/" -> "/render". Nothing but segments of plain characters: it becomes the beginning of addresses.
std::optional<std::string> parse_prefix(std::string_view text) {
  while (!text.empty() && text.back() == '/') text.remove_suffix(1);
  const bool is_clean = std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) || std::string_view("-._~/%").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (text.empty() || text.front() != '/' || text.find("//") != std::string_view::npos || !is_clean)
    return std::nullopt;
  return std::string(text);
}

}  // namespace

void believe_proxies(Request& request, const std::vector<Network>& trusted) {
  request.host = parse_authority(request.header("Host").value_or("")).value_or(Authority{});
  const auto peer = parse_address(std::string_view(request.client).substr(0, request.client.find('%')));
  if (!peer || !is_trusted(*peer, trusted)) return;
  const auto hops = values_from_right(request, "X-Forwarded-For");
  size_t place = 0;
  for (; place < hops.size(); ++place) {
    const auto address = parse_hop(hops[place]);
    if (!address) break;
    request.client = address_text(*address);
    if (!is_trusted(*address, trusted)) break;
  }
  const std::string scheme = value_at(request, "X-Forwarded-Proto", place);
  for (const char* known : {"http", "https"}) {
    if (is_same_name(scheme, known)) request.scheme = known;
  }
  if (auto host = parse_authority(value_at(request, "X-Forwarded-Host", place))) request.host = std::move(*host);
  request.prefix = parse_prefix(value_at(request, "X-Forwarded-Prefix", place)).value_or("");
}

}  // namespace tilelight::server
