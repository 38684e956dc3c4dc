// SPDX-License-Identifier: Apache-2.0
// Front: the sockets. One thread with epoll accepts connections, reads complete requests under limits on head, body,
// time, memory and number, and writes responses; only a complete request takes a worker. So slow clients cost memory
// that is capped, and never a thread: over the cap those go that hold most of it, and not those that come next.
// Pipelined requests are answered one after the other. A response may be a stream: it takes no worker, is asked for its
// next piece at each tick once the last has been taken, and so holds one piece for a slow reader and never more. Where
// memory is too short for a connection, it is closed, and the others go on.
//
// A client that shuts down its sending side waits for its answers (RFC 9112, 6.3) and gets them. One that has closed
// its connection looks the same until something is sent to it, which it answers with a reset. So while a worker has the
// request of such a client, the response's first bytes are sent ahead, which are the same whatever it will be: one
// after a second, then whenever the wait has doubled. A reset, and a peer that no longer answers the kernel's
// keep-alive probes, cancel the request.
#pragma once

#include <sys/epoll.h>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <new>
#include <stop_token>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "server/http/head.h"
#include "server/http/listener.h"
#include "server/http/protocol.h"
#include "server/http/unread.h"

namespace tilelight::server {

// A complete request on its way through a worker.
struct Exchange {
  uint64_t connection = 0;
  Head head;
  std::string body;
  std::string client;     // the peer's address
  std::stop_source gone;  // asked to stop when the client has left
  Served answer;          // once it is served
};

struct FrontOptions {
  std::string host = "127.0.0.1";
  int port = 0;  // 0: any free one
  int workers = 8;
  HeadLimits limits;
  size_t max_connections = 4096;
  int64_t max_buffered_bytes = int64_t{256} << 20;  // of bodies, all connections together
  int64_t max_unread_bytes = int64_t{512} << 20;    // of responses, likewise; two EXR images of the largest size fit
  double head_timeout_ms = 10'000.0;                // from a request's first byte to the end of its head
  double idle_timeout_ms = 60'000.0;                // between requests
  double write_timeout_ms = 20'000.0;               // without progress
  double probe_ms = 1'000.0;                        // from a client's end of sending to the first byte ahead
  double min_bytes_per_ms = 64.0;       // the slowest body, either way, that is waited for, beside the time-outs
  double brisk_bytes_per_ms = 1'024.0;  // a reader as fast as this keeps its response also where memory is short
};

class Front {
 public:
  // Runs a complete request; called by workers. Must not throw.
  using Serve = std::function<Served(Exchange&)>;
  // The whole response to a request refused before it was complete; called by the socket thread.
  using Refuse = std::function<Served(const Problem&, const std::string& client, bool is_head)>;

  // Errors: bind (the address cannot be had). Connections queue from here on; start() serves them.
  static Result<std::unique_ptr<Front>> bind(FrontOptions options, Serve serve, Refuse refuse);
  ~Front() { stop(0.0); }

  int port() const { return port_; }
  void start();
  // Accepts nothing more, gives the requests in progress grace_ms to be answered, then closes everything.
  void stop(double grace_ms);
  size_t connection_count() const { return connection_count_.load(std::memory_order_relaxed); }
  int64_t unread_bytes() const { return unread_bytes_.load(std::memory_order_relaxed); }

 private:
  static constexpr size_t kSmallBytes = 16 << 10;  // a head's worth: dropping less makes no room

  // streaming: between two pieces of a stream; closing: discards what the client still sends.
  enum class Phase { reading, serving, writing, streaming, closing };
  struct Connection {
    uint64_t id = 0;
    int fd = -1;
    uint32_t events = 0;  // epoll's interest
    Phase phase = Phase::reading;
    std::string client;
    std::string in;
    Served out;
    size_t written = 0;
    std::optional<Head> head;
    bool close_after = false, has_continued = false, has_skipped_line = false;
    size_t bytes_sent_ahead = 0;  // of the response, before it was there
    double half_closed_ms = 0.0;  // while it is being served: when its client ended its sending; 0: it has not
    double probe_at_ms = 0.0;
    double since_ms = 0.0;  // when its request, its response or its idleness began
    double deadline_ms = 0.0;
    std::shared_ptr<Exchange> exchange;
  };
  Front(FrontOptions options, Serve serve, Refuse refuse);
  static double now_ms();
  void run_loop();
  void take_event(const epoll_event& event);
  void check_all();
  void run_worker();
  void set_accepting(bool on);
  void accept_all();
  void add_connection(Peer&& peer);
  void handle_event(Connection& c, uint32_t events);
  void read_some(Connection& c);
  void advance(Connection& c);  // from bytes to a request
  void await_body(Connection& c);
  void hand_over(Connection& c);
  void refuse(Connection& c, const Problem& problem);
  // What becomes of a response; front_write.cpp.
  void begin_write(Connection& c, Served response);
  void write_some(Connection& c);
  void end_write(Connection& c);
  void pump_streams();
  void probe_half_closed();
  void discard(Connection& c);
  bool make_unread_room();
  void take_finished();
  void check_deadlines();
  bool make_room();
  void drop_largest_bodies();
  void watch(Connection& c, uint32_t events);
  void close_connection(uint64_t id);
  bool is_drained() const;

  // Acts on the connection, if it is still there, and closes it where memory is too short for that.
  template <class Act>
  void with_connection(uint64_t id, Act act) {
    const auto found = connections_.find(id);
    if (found == connections_.end()) return;
    try {
      act(*found->second);
    } catch (const std::bad_alloc&) {
      if (connections_.contains(id)) close_connection(id);
    }
  }

  // Constant after construction.
  const FrontOptions options_;
  const Serve serve_;
  const Refuse refuse_;
  int port_ = 0;
  int listener_ = -1, epoll_ = -1, wake_ = -1;

  // Only the socket thread's.
  std::unordered_map<uint64_t, std::unique_ptr<Connection>> connections_;
  uint64_t next_id_ = 16;  // smaller ones name the listener and the wake-up
  int64_t buffered_bytes_ = 0;
  Unread unread_;
  bool is_accepting_ = true;

  std::atomic<size_t> connection_count_ = 0;  // relaxed: gauges
  std::atomic<int64_t> unread_bytes_ = 0;
  std::atomic<bool> is_stopping_ = false;  // release by stop(), acquire by the loop
  std::atomic<double> stop_at_ms_ = 0.0;

  std::mutex mutex_;  // guards the rest
  std::condition_variable has_work_;
  // Lists, whose nodes workers move from the one to the other: to hand over an answer takes no memory.
  std::list<std::shared_ptr<Exchange>> waiting_, finished_;
  bool workers_end_ = false;

  std::vector<std::thread> workers_;
  std::thread loop_;
};

}  // namespace tilelight::server
