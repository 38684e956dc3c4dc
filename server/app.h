// SPDX-License-Identifier: Apache-2.0
// App: wires a server together from its configuration. Two can live in one process.
#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "server/config.h"
#include "server/http/http_server.h"

namespace tilelight::server {

class App {
 public:
  // Binds both ports; start() serves. `clock` must outlive it. Errors: bind.
  static Result<std::unique_ptr<App>> open(Config config, const Clock& clock);
  ~App() { stop(); }

  void start();
  // Refuses new work, cancels what waits, gives running renders a moment and cancels them, answers everybody who waits,
  // and ends all threads but the pool's. Takes a few seconds at most.
  void stop();

  int port() const { return http_->port(); }
  int admin_port() const { return admin_->port(); }
  std::string url() const;  // of the page
  std::string admin_url() const;
  Metrics& metrics() { return metrics_; }
  const Log& log() const { return log_; }

 private:
  App(Config config, const Clock& clock);
  void add_gauges();
  void housekeep(std::stop_token stop);

  const Config config_;
  std::atomic<bool> is_stopping_ = false;  // release by stop(), acquire by handlers
  bool has_stopped_ = false;

  // In the order in which they lean on each other; the last goes first. The pool ends before what its tasks log to.
  Log log_;
  Metrics metrics_;
  TilePool pool_;
  SceneStore scenes_;
  std::shared_ptr<CompiledCache> compiled_;
  std::shared_ptr<JobQueue> queue_;
  std::shared_ptr<Jobs> jobs_;
  KeptPictures pictures_;
  Sessions sessions_;
  IdempotencyKeys keys_;
  WaitSlots waits_, streams_;
  const Descriptions descriptions_;
  Services services_;
  std::unique_ptr<HttpServer> http_, admin_;
  std::jthread housekeeper_;
};

}  // namespace tilelight::server
