// SPDX-License-Identifier: Apache-2.0
#include "server/http/origin.h"

#include <algorithm>
#include <cctype>
#include <cstdint>

#include "server/address.h"
#include "server/http/text.h"

namespace tilelight::server {
namespace {

// reg-name (RFC 3986, 3.2.2), which IPv4 addresses are too. Behind a percent sign stand two hexadecimal digits.
bool is_name(std::string_view text) {
  constexpr std::string_view kOthers = "-._~%!$&'()*+,;=";
  for (size_t i = 0; i < text.size(); ++i) {
    const bool is_plain =
        std::isalnum(static_cast<unsigned char>(text[i])) || kOthers.find(text[i]) != std::string_view::npos;
    const std::string_view behind = text.substr(i + 1, 2);
    if (!is_plain || (text[i] == '%' && (behind.size() < 2 || !whole_number<uint8_t>(behind, 16)))) return false;
  }
  return !text.empty();
}

// The name, and what is left of the text: "", or a colon and a port.
std::optional<std::string> take_name(std::string_view& text) {
  if (text.empty() || text.front() != '[') {
    const std::string_view name = text.substr(0, text.find(':'));
    text.remove_prefix(name.size());
    return is_name(name) ? std::optional(lower(name)) : std::nullopt;
  }
  const size_t end = text.find(']');
  const std::string_view inside = text.substr(1, std::min(end, text.size()) - 1);
  const auto address = parse_address(inside);
  if (end == std::string_view::npos || !address || inside.find(':') == std::string_view::npos) return std::nullopt;
  text.remove_prefix(end + 1);
  return address_text(*address);
}

int default_port(std::string_view scheme) { return scheme == "https" ? 443 : 80; }

}  // namespace

std::optional<Authority> parse_authority(std::string_view text) {
  const auto name = take_name(text);
  if (!name) return std::nullopt;
  Authority out{*name, std::nullopt};
  if (text.empty()) return out;
  if (text.front() != ':') return std::nullopt;
  text.remove_prefix(1);
  if (text.empty()) return out;  // "localhost:" is lawful
  out.port = is_digits(text) ? whole_number<uint16_t>(text) : std::nullopt;
  return out.port ? std::optional(out) : std::nullopt;
}

std::string authority_text(const Authority& authority) {
  const bool is_ipv6 = authority.name.find(':') != std::string::npos;
  const std::string name = is_ipv6 ? "[" + authority.name + "]" : authority.name;
  return authority.port ? name + ":" + std::to_string(*authority.port) : name;
}

bool is_same_origin(std::string_view origin, const Authority& host, std::string_view scheme) {
  const size_t colon = origin.find("://");
  if (colon == std::string_view::npos) return false;
  const std::string of_origin = lower(origin.substr(0, colon));
  if (of_origin != "http" && of_origin != "https") return false;
  if (!scheme.empty() && scheme != of_origin) return false;
  const auto page = parse_authority(origin.substr(colon + 3));
  if (!page || page->name != host.name) return false;
  const int port = default_port(of_origin);
  return page->port.value_or(port) == host.port.value_or(port);
}

}  // namespace tilelight::server
