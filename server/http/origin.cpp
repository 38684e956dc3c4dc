// SPDX-License-Identifier: Apache-2.0
#include "server/http/origin.h"

#include <algorithm>
#include <cctype>

#include "server/address.h"
#include "server/http/text.h"

namespace tilelight::server {
namespace {

// reg-name, percent signs included (RFC 3986, 3.2.2).
bool is_name(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) || std::string_view("-._~%!$&'()*+,;=").find(static_cast<char>(c)) != std::string_view::npos;
  });
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
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
  const bool is_digits = std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
  out.port = is_digits ? whole_number<int>(text) : std::nullopt;
  if (!out.port || *out.port > 65'535) return std::nullopt;
  return out;
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
