// SPDX-License-Identifier: Apache-2.0
// The front's way with responses: written as fast as the client reads, within limits of time and memory.
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/uio.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <utility>

#include "server/http/front.h"

namespace tilelight::server {
namespace {

constexpr size_t kWriteBytes = 1 << 20;  // at a time, so that one fast reader of a large image does not hold the loop
constexpr double kLingerMs = 2'000.0;    // for a refused client to read its answer before the reset

// The response from a place on, its own bytes and the shared ones in one call: two would leave as two packets.
ssize_t send_from(int fd, const Served& response, size_t at) {
  iovec parts[2];
  size_t count = 0;
  const auto add = [&](const std::string& bytes) {
    if (at < bytes.size()) parts[count++] = {const_cast<char*>(bytes.data()) + at, bytes.size() - at};
    at -= std::min(at, bytes.size());
  };
  add(response.bytes);
  if (response.body) add(*response.body);
  msghdr message{};
  message.msg_iov = parts;
  message.msg_iovlen = count;
  return sendmsg(fd, &message, MSG_NOSIGNAL);
}

// Adds the stream's next piece, and its end.
void pull(Served& response) {
  std::optional<std::string> piece;
  try {
    piece = response.stream->next();
  } catch (const std::exception&) {  // without the last chunk the client sees that it is cut short
    response.stream = nullptr;
    response.close = true;
    return;
  }
  if (piece && piece->empty()) return;
  if (!piece) response.stream = nullptr;
  if (!response.is_chunked) {
    response.bytes += piece.value_or("");
    return;
  }
  char size[32];
  std::snprintf(size, sizeof size, "%zx\r\n", piece ? piece->size() : 0);
  response.bytes += size + piece.value_or("") + "\r\n";
}

}  // namespace

void Front::begin_write(Connection& c, Served response) {
  if (response.stream) pull(response);
  unread_.add(response);
  if (response.size() > kSmallBytes && !make_unread_room()) {
    unread_.remove(response);
    const Problem full{503, "memory", "too many clients read large responses slowly", {}, {{"Retry-After", "5"}}};
    response = refuse_(full, c.client, false);
    unread_.add(response);
  }
  c.phase = Phase::writing;
  c.out = std::move(response);
  c.written = std::exchange(c.bytes_sent_ahead, 0);
  c.close_after = c.out.close;
  if (c.close_after) {  // what else it sends is not read
    buffered_bytes_ -= static_cast<int64_t>(c.in.size());
    std::string().swap(c.in);
  }
  c.since_ms = now_ms();
  c.deadline_ms = c.since_ms + options_.write_timeout_ms;
  write_some(c);
}

void Front::write_some(Connection& c) {
  const size_t turn_end = c.written + kWriteBytes;
  while (c.written < c.out.size()) {
    if (c.written >= turn_end) return watch(c, EPOLLOUT);
    const ssize_t sent = send_from(c.fd, c.out, c.written);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0 && errno == EAGAIN) return watch(c, EPOLLOUT);
    if (sent < 0) return close_connection(c.id);
    c.written += static_cast<size_t>(sent);
    // A reader of a byte a second makes progress; the rate ends it.
    const double slowest_ms = options_.write_timeout_ms + static_cast<double>(c.out.size()) / options_.min_bytes_per_ms;
    c.deadline_ms = std::min(now_ms() + options_.write_timeout_ms, c.since_ms + slowest_ms);
  }
  end_write(c);
}

void Front::end_write(Connection& c) {
  unread_.remove(c.out);
  if (c.out.stream) {
    c.out.bytes.clear();
    c.phase = Phase::streaming;
    c.deadline_ms = INFINITY;
    return watch(c, EPOLLRDHUP);
  }
  c.out = {};
  if (c.close_after) {
    // Closing at once would reset the connection under what the client still sends and lose the answer.
    shutdown(c.fd, SHUT_WR);
    c.phase = Phase::closing;
    c.since_ms = now_ms();
    c.deadline_ms = c.since_ms + kLingerMs;
    return watch(c, EPOLLIN);
  }
  c.phase = Phase::reading;
  c.since_ms = now_ms();
  c.deadline_ms = c.since_ms + (c.in.empty() ? options_.idle_timeout_ms : options_.head_timeout_ms);
  watch(c, EPOLLIN | EPOLLRDHUP);
  if (!c.in.empty()) advance(c);  // the next request was sent along
}

void Front::pump_streams() {
  std::vector<uint64_t> ready;  // writing may close a connection, and so change the map
  for (const auto& [id, c] : connections_) {
    if (c->phase == Phase::streaming) ready.push_back(id);
  }
  for (const uint64_t id : ready) {
    with_connection(id, [&](Connection& c) {
      pull(c.out);
      if (c.out.bytes.empty() && c.out.stream) return;
      unread_.add(c.out);
      c.phase = Phase::writing;
      c.written = 0;
      c.close_after |= c.out.close;
      c.since_ms = now_ms();
      c.deadline_ms = c.since_ms + options_.write_timeout_ms;
      write_some(c);
    });
  }
}

void Front::probe_half_closed() {
  const double now = now_ms();
  std::vector<uint64_t> late;
  for (const auto& [id, c] : connections_) {
    if (c->phase == Phase::serving && c->half_closed_ms > 0.0 && now >= c->probe_at_ms) late.push_back(id);
  }
  for (const uint64_t id : late) {
    Connection& c = *connections_.at(id);
    if (c.bytes_sent_ahead == kResponseStart.size()) continue;
    const ssize_t sent = send(c.fd, kResponseStart.data() + c.bytes_sent_ahead, 1, MSG_NOSIGNAL);
    if (sent < 0 && errno != EAGAIN && errno != EINTR) {
      close_connection(id);
      continue;
    }
    c.bytes_sent_ahead += sent > 0;
    c.probe_at_ms = now + (now - c.half_closed_ms);
  }
}

void Front::discard(Connection& c) {
  char ignored[16 << 10];
  const ssize_t got = recv(c.fd, ignored, sizeof ignored, 0);
  if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) close_connection(c.id);
}

// Over the budget the largest responses go whose readers are slow, of equal ones the oldest. False: that was not
// enough, and the new one must be given up; clients that read briskly are not cut off for its sake.
bool Front::make_unread_room() {
  const double now = now_ms();
  while (unread_.bytes() > options_.max_unread_bytes) {
    const Connection* largest = nullptr;
    for (const auto& [id, c] : connections_) {
      if (c->phase != Phase::writing || c->out.size() < kSmallBytes) continue;
      if (static_cast<double>(c->written) >= (now - c->since_ms) * options_.brisk_bytes_per_ms) continue;
      const auto rank = [](const Connection& x) { return std::pair(x.out.size(), -x.since_ms); };
      if (!largest || rank(*c) > rank(*largest)) largest = c.get();
    }
    if (!largest) return false;
    close_connection(largest->id);
  }
  return true;
}

}  // namespace tilelight::server
