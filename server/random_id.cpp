// SPDX-License-Identifier: Apache-2.0
#include "server/random_id.h"

#include <sys/random.h>

#include <cerrno>
#include <stdexcept>
#include <vector>

namespace tilelight::server {

std::string random_hex(int bytes) {
  std::vector<unsigned char> raw(static_cast<size_t>(bytes));
  for (size_t have = 0; have < raw.size();) {
    const ssize_t got = getrandom(raw.data() + have, raw.size() - have, 0);
    if (got < 0 && errno != EINTR) throw std::runtime_error("getrandom failed");
    if (got > 0) have += static_cast<size_t>(got);
  }
  constexpr char kDigits[] = "0123456789abcdef";
  std::string hex;
  hex.reserve(raw.size() * 2);
  for (const unsigned char byte : raw) hex += kDigits[byte >> 4], hex += kDigits[byte & 15];
  return hex;
}

}  // namespace tilelight::server
