// SPDX-License-Identifier: Apache-2.0
#include "server/address.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <sys/socket.h>

#include <algorithm>
#include <charconv>
#include <memory>

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
  const auto parsed = parse_address(std::string_view(address).substr(0, address.find('%')));
  static const Network kV4 = *parse_network("127.0.0.0/8"), kV6 = *parse_network("::1");
  return parsed && (kV4.holds(*parsed) || kV6.holds(*parsed));
}

bool is_any_address(const std::string& address) {
  const auto parsed = parse_address(std::string_view(address).substr(0, address.find('%')));
  static const Network kV4 = *parse_network("0.0.0.0"), kV6 = *parse_network("::");
  return parsed && (kV4.holds(*parsed) || kV6.holds(*parsed));
}

}  // namespace tilelight::server
