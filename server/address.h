// SPDX-License-Identifier: Apache-2.0
// Internet addresses and networks of them: IPv4 and IPv6 in one space, in which ::ffff:192.0.2.1 is 192.0.2.1.
// A leaf; plain values, pure but for the look-up of names.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/renderer.h"

namespace tilelight::server {

struct Address {
  std::array<uint8_t, 16> bytes{};  // IPv6, most significant first
};

// "192.0.2.1", "2001:db8::1"; no brackets, no port, no zone.
std::optional<Address> parse_address(std::string_view text);
// The shortest spelling (RFC 5952), so that one address has one text.
std::string address_text(const Address& address);

struct Network {
  Address first;
  int bits = 128;  // of the address that all its members share

  bool holds(const Address& address) const;
};

// "192.0.2.1", "10.0.0.0/8", "fd00::/8". The error is a sentence.
Result<Network> parse_network(std::string_view text);

// The numeric addresses (IPv4, IPv6) that a name of this machine stands for, in the system's order, each once. Errors:
// no_address.
using Resolve = std::function<Result<std::vector<std::string>>(const std::string& host)>;
Result<std::vector<std::string>> resolve_host(const std::string& host);

// Whether only this machine reaches a numeric address: 127.0.0.0/8, also within IPv6, and ::1.
bool is_loopback(const std::string& address);
// Whether it stands for all of this machine's addresses: 0.0.0.0 and ::.
bool is_any_address(const std::string& address);

}  // namespace tilelight::server
