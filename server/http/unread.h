// SPDX-License-Identifier: Apache-2.0
// Unread: the memory of the responses that clients have not read to their ends. A body that several of them share
// counts once. One thread's.
#pragma once

#include <unordered_map>

#include "server/http/protocol.h"

namespace tilelight::server {

class Unread {
 public:
  void add(const Served& response) {
    // First what may find no memory, and then counts nothing.
    if (response.body && ++readers_[response.body.get()] == 1) bytes_ += static_cast<int64_t>(response.body->size());
    bytes_ += static_cast<int64_t>(response.bytes.size());
  }
  void remove(const Served& response) {
    bytes_ -= static_cast<int64_t>(response.bytes.size());
    if (!response.body || --readers_.at(response.body.get()) > 0) return;
    readers_.erase(response.body.get());
    bytes_ -= static_cast<int64_t>(response.body->size());
  }
  int64_t bytes() const { return bytes_; }

 private:
  int64_t bytes_ = 0;
  std::unordered_map<const std::string*, int> readers_;  // of each shared body
};

}  // namespace tilelight::server
