// SPDX-License-Identifier: Apache-2.0
#include "server/address.h"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>

namespace tilelight::server {
namespace {

constexpr std::array<uint8_t, 12> kMapped = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};

bool is_v4(const Address& address) { return std::equal(kMapped.begin(), kMapped.end(), address.bytes.begin()); }

// The address with all bits after the first `bits` cleared.
Address masked(Address address, int bits) {
  for (int i = 0; i < 16; ++i) {
    const int kept = std::clamp(bits - 8 * i, 0, 8);
    address.bytes[static_cast<size_t>(i)] &= static_cast<uint8_t>(0xff00 >> kept);
  }
  return address;
}

}  // namespace

std::optional<Address> parse_address(std::string_view text) {
  const std::string copy(text);
  Address address;
  if (copy.size() != std::string_view(copy.c_str()).size()) return std::nullopt;  // a NUL ends it for inet_pton
  if (inet_pton(AF_INET6, copy.c_str(), address.bytes.data()) == 1) return address;
  std::copy(kMapped.begin(), kMapped.end(), address.bytes.begin());
  if (inet_pton(AF_INET, copy.c_str(), address.bytes.data() + kMapped.size()) == 1) return address;
  return std::nullopt;
}

std::string address_text(const Address& address) {
  char text[INET6_ADDRSTRLEN] = "";
  if (is_v4(address)) {
    inet_ntop(AF_INET, address.bytes.data() + kMapped.size(), text, sizeof text);
  } else {
    inet_ntop(AF_INET6, address.bytes.data(), text, sizeof text);
  }
  return text;
}

bool Network::holds(const Address& address) const { return masked(address, bits).bytes == first.bytes; }

Result<Network> parse_network(std::string_view text) {
  const std::string quoted = "'" + std::string(text) + "'";
  const size_t slash = text.find('/');
  const auto address = parse_address(text.substr(0, slash));
  if (!address) {
    return fail("bad_value", quoted + " is neither an address nor a network: 127.0.0.1, ::1, 10.0.0.0/8, fd00::/8");
  }
  if (slash == std::string_view::npos) return Network{*address, 128};
  const bool is_dotted = text.find(':') == std::string_view::npos;
  const int most = is_dotted ? 32 : 128;
  const std::string_view digits = text.substr(slash + 1);
  int bits = -1;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), bits);
  if (error != std::errc() || end != digits.data() + digits.size() || bits < 0 || bits > most) {
    return fail("bad_value", quoted + ": after the / stands the number of bits, 0 to " + std::to_string(most));
  }
  const Network network{masked(*address, bits + 128 - most), bits + 128 - most};
  if (network.first.bytes != address->bytes) {
    return fail("bad_value", quoted + " is an address inside the network " + address_text(network.first) + "/" +
                                 std::to_string(bits) + "; write the one that is meant");
  }
  return network;
}

}  // namespace tilelight::server
