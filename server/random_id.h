// SPDX-License-Identifier: Apache-2.0
// Ids that cannot be guessed. Any thread.
#pragma once

#include <string>

namespace tilelight::server {

// 2 * bytes lower-case hexadecimal digits from the kernel's random source.
std::string random_hex(int bytes);

inline std::string random_id() { return random_hex(16); }  // 128 bits

}  // namespace tilelight::server
