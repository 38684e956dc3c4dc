// SPDX-License-Identifier: Apache-2.0
// Hosts and origins as browsers write them (RFC 3986, 3.2; RFC 6454). Pure.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tilelight::server {

// What a Host header says, and the host of an address.
struct Authority {
  std::string name;         // in lower case; an IPv6 address without its brackets
  std::optional<int> port;  // nothing: the scheme's
};

// "render.example", "localhost:8080", "[::1]:80". Nothing for anything that no Host may be.
std::optional<Authority> parse_authority(std::string_view text);
std::string authority_text(const Authority& authority);

// Whether a page of this origin ("https://render.example") is a page of the host: scheme, name and port are the same,
// where a port left out is the scheme's, 80 or 443. scheme: of the host; empty where it is not known, and then the
// origin's.
bool is_same_origin(std::string_view origin, const Authority& host, std::string_view scheme);

}  // namespace tilelight::server
