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
// Binds a numeric address (IPv4 or IPv6). Errors: bind.
Result<Listener> listen_on(const std::string& host, int port);

struct Peer {
  int fd = -1;
  std::string address;
};
enum class AcceptError { nothing_now, no_descriptors };
::tl::expected<Peer, AcceptError> accept_peer(int listener);

}  // namespace tilelight::server
