// SPDX-License-Identifier: Apache-2.0
// A listening TCP socket and the connections that come of it. Non-blocking, closed on exec.
#pragma once

#include <string>

#include "renderer/renderer.h"

namespace tilelight::server {

struct Listener {
  int fd = -1;
  int port = 0;  // the real one where 0 was asked for
};
// Binds a numeric address (IPv4 or IPv6). Errors: no_address (this machine does not have it), bind.
Result<Listener> listen_on(const std::string& host, int port);

struct Peer {
  int fd = -1;
  std::string address;
};
enum class AcceptError { nothing_now, no_room };  // no_room: for descriptors or memory
::tl::expected<Peer, AcceptError> accept_peer(int listener);

}  // namespace tilelight::server
