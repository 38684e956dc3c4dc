// SPDX-License-Identifier: Apache-2.0
// The addresses that a name of this machine stands for. A leaf; pure but for the look-up.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "renderer/renderer.h"

namespace tilelight::server {

// Numeric addresses (IPv4, IPv6), in the system's order, each once. Errors: no_address.
using Resolve = std::function<Result<std::vector<std::string>>(const std::string& host)>;
Result<std::vector<std::string>> resolve_host(const std::string& host);

// Whether only this machine reaches a numeric address: 127.0.0.0/8, also within IPv6, and ::1.
bool is_loopback(const std::string& address);
// Whether it stands for all of this machine's addresses: 0.0.0.0 and ::.
bool is_any_address(const std::string& address);

}  // namespace tilelight::server
