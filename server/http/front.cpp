// SPDX-License-Identifier: Apache-2.0
#include "server/http/front.h"

#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>

#include "server/clock.h"

namespace tilelight::server {
namespace {

constexpr uint64_t kListenerId = 0, kWakeId = 1;
constexpr int kTickMs = 250;             // how often deadlines and streams are looked at
constexpr size_t kReadBytes = 64 << 10;  // at a time, so that one fast sender does not hold the loop

}  // namespace

double Front::now_ms() { return SystemClock().mono_ms(); }

Front::Front(FrontOptions options, Serve serve, Refuse refuse)
    : options_(std::move(options)), serve_(std::move(serve)), refuse_(std::move(refuse)) {}

Result<std::unique_ptr<Front>> Front::bind(FrontOptions options, Serve serve, Refuse refuse) {
  auto listener = listen_on(options.host, options.port);
  if (!listener) return ::tl::unexpected(listener.error());
  std::unique_ptr<Front> front(new Front(std::move(options), std::move(serve), std::move(refuse)));
  front->listener_ = listener->fd;
  front->port_ = listener->port;
  front->epoll_ = epoll_create1(EPOLL_CLOEXEC);
  front->wake_ = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (front->epoll_ < 0 || front->wake_ < 0) return fail("bind", "no descriptors left for the socket thread");
  for (const auto& [fd, id] : {std::pair{front->listener_, kListenerId}, std::pair{front->wake_, kWakeId}}) {
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.u64 = id;
    epoll_ctl(front->epoll_, EPOLL_CTL_ADD, fd, &event);
  }
  return front;
}

void Front::start() {
  for (int i = 0; i < options_.workers; ++i) workers_.emplace_back([this] { run_worker(); });
  loop_ = std::thread([this] { run_loop(); });
}

void Front::stop(double grace_ms) {
  stop_at_ms_.store(now_ms() + grace_ms, std::memory_order_relaxed);
  is_stopping_.store(true, std::memory_order_release);
  if (wake_ >= 0) eventfd_write(wake_, 1);
  if (loop_.joinable()) loop_.join();
  {
    const std::lock_guard lock(mutex_);
    workers_end_ = true;
  }
  has_work_.notify_all();
  for (std::thread& worker : workers_) worker.join();
  workers_.clear();
  for (int* fd : {&listener_, &epoll_, &wake_}) {
    if (*fd >= 0) ::close(*fd);
    *fd = -1;
  }
}

void Front::run_worker() {
  for (;;) {
    std::unique_lock lock(mutex_);
    has_work_.wait(lock, [&] { return workers_end_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    std::list<std::shared_ptr<Exchange>> mine;
    mine.splice(mine.end(), waiting_, waiting_.begin());
    lock.unlock();
    Exchange& exchange = *mine.front();
    exchange.answer = serve_(exchange);
    lock.lock();
    finished_.splice(finished_.end(), mine);
    lock.unlock();
    eventfd_write(wake_, 1);
  }
}

void Front::run_loop() {
  std::vector<epoll_event> events(256);
  double next_check_ms = now_ms() + kTickMs;
  for (;;) {
    // What came before the stop and has not been looked at is answered too: the loop ends at a look that finds nothing.
    const bool may_end = is_stopping_.load(std::memory_order_acquire) && is_drained();
    const int count = epoll_wait(epoll_, events.data(), static_cast<int>(events.size()), may_end ? 0 : kTickMs);
    for (int i = 0; i < count; ++i) take_event(events[static_cast<size_t>(i)]);
    unread_bytes_.store(unread_.bytes(), std::memory_order_relaxed);
    const double now = now_ms();
    if (now >= next_check_ms) {
      check_all();
      next_check_ms = now + kTickMs;
    }
    if (is_stopping_.load(std::memory_order_acquire)) {
      set_accepting(false);
      if ((may_end && count == 0) || now >= stop_at_ms_.load(std::memory_order_relaxed)) break;
    }
  }
  while (!connections_.empty()) close_connection(connections_.begin()->first);
}

void Front::take_event(const epoll_event& event) {
  const uint64_t id = event.data.u64;
  if (id == kListenerId) {
    accept_all();
  } else if (id == kWakeId) {
    eventfd_t ignored;
    eventfd_read(wake_, &ignored);
    take_finished();
  } else {
    with_connection(id, [&](Connection& c) { handle_event(c, event.events); });
  }
  drop_largest_bodies();
}

void Front::check_all() {
  try {
    check_deadlines();
    pump_streams();
    probe_half_closed();
  } catch (const std::bad_alloc&) {
    // No memory for a list of the connections that are due; they are still due at the next tick.
  }
  set_accepting(true);
}

bool Front::is_drained() const {
  for (const auto& [id, c] : connections_) {
    if (c->phase == Phase::serving || c->phase == Phase::writing || c->phase == Phase::streaming) return false;
  }
  return true;
}

// A listener that nobody can serve would wake the loop for ever; it comes back at the next tick.
void Front::set_accepting(bool on) {
  if (on == is_accepting_) return;
  is_accepting_ = on;
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.u64 = kListenerId;
  epoll_ctl(epoll_, on ? EPOLL_CTL_ADD : EPOLL_CTL_DEL, listener_, &event);
}

void Front::accept_all() {
  for (;;) {
    if (connections_.size() >= options_.max_connections && !make_room()) return set_accepting(false);
    auto peer = accept_peer(listener_);
    if (!peer) {
      if (peer.error() == AcceptError::nothing_now) return;
      if (make_room()) continue;
      return set_accepting(false);
    }
    try {
      add_connection(std::move(*peer));
    } catch (const std::bad_alloc&) {
      ::close(peer->fd);
      return set_accepting(false);
    }
  }
}

void Front::add_connection(Peer&& peer) {
  const uint64_t id = next_id_++;
  Connection& c = *connections_.emplace(id, std::make_unique<Connection>()).first->second;
  c.id = id;
  c.fd = peer.fd;
  c.client = std::move(peer.address);
  c.since_ms = now_ms();
  c.deadline_ms = c.since_ms + options_.head_timeout_ms;
  c.events = EPOLLIN | EPOLLRDHUP;
  epoll_event event{};
  event.events = c.events;
  event.data.u64 = id;
  epoll_ctl(epoll_, EPOLL_CTL_ADD, c.fd, &event);
  connection_count_.store(connections_.size(), std::memory_order_relaxed);
}

// Full: the connection that has kept us waiting longest for a request goes. False: all are being served.
bool Front::make_room() {
  const Connection* oldest = nullptr;
  for (const auto& [id, c] : connections_) {
    if (c->phase == Phase::serving || c->phase == Phase::writing || c->phase == Phase::streaming) continue;
    if (!oldest || c->since_ms < oldest->since_ms) oldest = c.get();
  }
  if (oldest) close_connection(oldest->id);
  return oldest != nullptr;
}

void Front::handle_event(Connection& c, uint32_t events) {
  // Where both sides have ended their sending: read the client's unread bytes first; closing over them would reset the
  // connection and lose the answer.
  const bool has_left = (events & EPOLLERR) || ((events & EPOLLHUP) && c.phase != Phase::closing);
  if (has_left) return close_connection(c.id);
  switch (c.phase) {
    case Phase::reading:
      return read_some(c);
    case Phase::serving:
      if ((events & EPOLLRDHUP) == 0) return;
      c.half_closed_ms = now_ms();
      c.probe_at_ms = c.half_closed_ms + options_.probe_ms;
      return watch(c, 0);
    case Phase::writing:
      return write_some(c);
    case Phase::streaming:
      return watch(c, 0);  // the client has ended its sending; it may still listen, and the next piece tells
    case Phase::closing:
      return discard(c);
  }
}

void Front::read_some(Connection& c) {
  char bytes[kReadBytes];
  const ssize_t got = recv(c.fd, bytes, sizeof bytes, 0);
  if (got == 0 && !c.in.empty()) {
    return refuse(c, Problem{400, "bad_request", "the connection ended before the request was complete", {}, {}});
  }
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (got <= 0) return close_connection(c.id);
  if (c.in.empty()) c.since_ms = now_ms(), c.deadline_ms = c.since_ms + options_.head_timeout_ms;
  // A body's declared length is bounded, and its memory is taken as it arrives, not as it is declared.
  c.in.append(bytes, static_cast<size_t>(got));
  buffered_bytes_ += got;
  advance(c);
}

void Front::advance(Connection& c) {
  if (!c.head && !c.has_skipped_line) {
    const size_t skipped = empty_line_bytes(c.in);
    c.has_skipped_line = skipped > 0;
    c.in.erase(0, skipped);
    buffered_bytes_ -= static_cast<int64_t>(skipped);
    if (c.in.empty()) c.deadline_ms = c.since_ms + options_.idle_timeout_ms;
  }
  if (!c.head) {
    auto head = scan_head(c.in, options_.limits);
    if (!head) return refuse(c, head.error());
    if (!*head) return;
    c.head = std::move(**head);
    c.has_continued = false;
  }
  if (c.in.size() < c.head->bytes + static_cast<size_t>(c.head->body_bytes)) return await_body(c);
  hand_over(c);
}

void Front::await_body(Connection& c) {
  if (c.has_continued) return;
  c.has_continued = true;
  c.deadline_ms =
      now_ms() + options_.head_timeout_ms + static_cast<double>(c.head->body_bytes) / options_.min_bytes_per_ms;
  constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
  if (c.head->expects_continue) send(c.fd, kContinue.data(), kContinue.size(), MSG_NOSIGNAL);
}

void Front::hand_over(Connection& c) {
  auto exchange = std::make_shared<Exchange>();
  const size_t body_bytes = static_cast<size_t>(c.head->body_bytes), end = c.head->bytes + body_bytes;
  exchange->connection = c.id;
  exchange->client = c.client;
  exchange->body = c.in.substr(c.head->bytes, body_bytes);
  exchange->head = std::move(*c.head);
  c.in.erase(0, end);
  if (c.in.empty()) std::string().swap(c.in);                 // gives a large body's memory back
  buffered_bytes_ -= static_cast<int64_t>(end - body_bytes);  // the body counts until it is answered
  c.head.reset();
  c.has_skipped_line = false;
  c.bytes_sent_ahead = 0;
  c.half_closed_ms = 0.0;
  c.phase = Phase::serving;
  c.deadline_ms = INFINITY;
  c.exchange = exchange;
  watch(c, EPOLLRDHUP);
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(exchange));
  }
  has_work_.notify_one();
}

void Front::take_finished() {
  std::list<std::shared_ptr<Exchange>> finished;
  {
    const std::lock_guard lock(mutex_);
    finished.swap(finished_);
  }
  for (const auto& exchange : finished) {
    with_connection(exchange->connection, [&](Connection& c) {
      buffered_bytes_ -= static_cast<int64_t>(exchange->body.size());
      c.exchange = nullptr;
      begin_write(c, std::move(exchange->answer));
    });
  }
}

void Front::refuse(Connection& c, const Problem& problem) {
  begin_write(c, refuse_(problem, c.client, c.in.rfind("HEAD ", 0) == 0));
}

// Over the budget the largest body that is still arriving goes, the oldest of equals: whoever stalls with a large one
// must not be the reason to refuse the next.
void Front::drop_largest_bodies() {
  while (buffered_bytes_ > options_.max_buffered_bytes) {
    const Connection* largest = nullptr;
    for (const auto& [id, c] : connections_) {
      if (c->phase != Phase::reading || c->in.size() < kSmallBytes) continue;
      const auto rank = [](const Connection& it) { return std::pair(it.in.size(), -it.since_ms); };
      if (!largest || rank(*c) > rank(*largest)) largest = c.get();
    }
    if (!largest) return;
    with_connection(largest->id, [&](Connection& c) {
      refuse(c, Problem{503, "memory", "too many large bodies are arriving at once", {}, {{"Retry-After", "1"}}});
    });
  }
}

void Front::check_deadlines() {
  const double now = now_ms();
  std::vector<uint64_t> late;
  for (const auto& [id, c] : connections_) {
    if (now >= c->deadline_ms) late.push_back(id);
  }
  for (const uint64_t id : late) {
    with_connection(id, [&](Connection& c) {
      if (c.phase != Phase::reading || c.in.empty()) return close_connection(id);
      refuse(c, Problem{408, "timeout", "the request did not arrive in time", {}, {}});
    });
  }
}

void Front::watch(Connection& c, uint32_t events) {
  if (c.events == events) return;
  c.events = events;
  epoll_event event{};
  event.events = events;
  event.data.u64 = c.id;
  epoll_ctl(epoll_, EPOLL_CTL_MOD, c.fd, &event);
}

void Front::close_connection(uint64_t id) {
  const auto found = connections_.find(id);
  Connection& c = *found->second;
  buffered_bytes_ -= static_cast<int64_t>(c.in.size());
  if (c.phase == Phase::writing) unread_.remove(c.out);
  if (c.exchange) {
    buffered_bytes_ -= static_cast<int64_t>(c.exchange->body.size());
    c.exchange->gone.request_stop();
  }
  ::close(c.fd);
  connections_.erase(found);
  connection_count_.store(connections_.size(), std::memory_order_relaxed);
}

}  // namespace tilelight::server
