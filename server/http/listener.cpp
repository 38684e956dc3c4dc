// SPDX-License-Identifier: Apache-2.0
#include "server/http/listener.h"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <new>

namespace tilelight::server {
namespace {

// A peer whose machine is gone answers nothing: it is noticed after 30 s of silence and three probes, 10 s apart.
constexpr int kSilenceS = 30, kProbeS = 10, kProbes = 3;
constexpr int kBacklog = 1024;  // a burst of connects waits here instead of being retried after a second

// Numeric address of a peer. IPv4 that came over IPv6 reads as IPv4.
std::string address_text(const sockaddr_storage& address, socklen_t size) {
  char text[NI_MAXHOST] = "";
  getnameinfo(reinterpret_cast<const sockaddr*>(&address), size, text, sizeof text, nullptr, 0, NI_NUMERICHOST);
  const std::string out = text;
  return out.rfind("::ffff:", 0) == 0 ? out.substr(7) : out;
}

int port_of(int fd) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.ss_family == AF_INET6 ? reinterpret_cast<const sockaddr_in6&>(address).sin6_port
                                             : reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

}  // namespace

Result<Listener> listen_on(const std::string& host, int port) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICHOST | AI_NUMERICSERV;  // no look-up: it was checked before
  addrinfo* found = nullptr;
  const std::string where =
      (host.find(':') == std::string::npos ? host : "[" + host + "]") + ":" + std::to_string(port);
  if (const int code = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found); code != 0) {
    return fail("bind", "cannot listen on " + where + ": " + gai_strerror(code));
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, freeaddrinfo);
  int cause = EADDRNOTAVAIL;
  for (const addrinfo* a = found; a; a = a->ai_next) {
    const int fd = socket(a->ai_family, a->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, a->ai_protocol);
    const int on = 1;
    if (fd >= 0 && setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) == 0 &&
        bind(fd, a->ai_addr, a->ai_addrlen) == 0 && listen(fd, kBacklog) == 0) {
      return Listener{fd, port_of(fd)};
    }
    cause = errno;
    if (fd >= 0) close(fd);
  }
  const bool is_absent = cause == EADDRNOTAVAIL || cause == EAFNOSUPPORT;
  return fail(is_absent ? "no_address" : "bind", "cannot listen on " + where + ": " + std::strerror(cause));
}

::tl::expected<Peer, AcceptError> accept_peer(int listener) {
  for (;;) {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    const int fd = accept4(listener, reinterpret_cast<sockaddr*>(&address), &size, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (fd >= 0) {
      const int on = 1;  // answers leave whole; without this the last segment waits for an acknowledgement
      setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
      setsockopt(fd, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
      setsockopt(fd, IPPROTO_TCP, TCP_KEEPIDLE, &kSilenceS, sizeof kSilenceS);
      setsockopt(fd, IPPROTO_TCP, TCP_KEEPINTVL, &kProbeS, sizeof kProbeS);
      setsockopt(fd, IPPROTO_TCP, TCP_KEEPCNT, &kProbes, sizeof kProbes);
      try {
        return Peer{fd, address_text(address, size)};
      } catch (const std::bad_alloc&) {
        close(fd);
        return ::tl::unexpected(AcceptError::no_room);
      }
    }
    if (errno == EINTR || errno == ECONNABORTED) continue;
    const bool is_full = errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM;
    return ::tl::unexpected(is_full ? AcceptError::no_room : AcceptError::nothing_now);
  }
}

}  // namespace tilelight::server
