// SPDX-License-Identifier: Apache-2.0
// Services: what the handlers work with. References into the App; any thread.
#pragma once

#include <atomic>
#include <map>
#include <mutex>

#include "server/config.h"
#include "server/http/documents.h"
#include "server/http/message.h"
#include "server/jobs/idempotency.h"
#include "server/jobs/jobs.h"
#include "server/jobs/kept_pictures.h"
#include "server/sessions/sessions.h"

namespace tilelight::server {

// The budget of workers that may wait for something else than the processor, so that waiting never takes the workers
// that answer others. One client may hold three quarters of it, so that the rest stays for others. Any thread.
class WaitSlots {
 public:
  explicit WaitSlots(int count) : most_by_client_(count - count / 4), free_(count) {}

  class Slot {
   public:
    Slot(WaitSlots* owner, std::string client) : owner_(owner), client_(std::move(client)) {}
    Slot(Slot&& other) noexcept : owner_(std::exchange(other.owner_, nullptr)), client_(std::move(other.client_)) {}
    Slot& operator=(Slot&&) = delete;
    ~Slot() {
      if (owner_) owner_->give_back(client_);
    }

   private:
    WaitSlots* owner_;
    std::string client_;
  };
  // A slot, or 429 where this client has its share, or 503 where there is none left.
  ::tl::expected<Slot, Problem> take(const std::string& client);
  int free() const;

 private:
  void give_back(const std::string& client);

  const int most_by_client_;
  mutable std::mutex mutex_;  // guards the rest
  int free_;
  std::map<std::string, int> by_client_;  // of who holds any
};

struct Services {
  const Config& config;
  const Log& log;
  Metrics& metrics;
  TilePool& pool;
  SceneStore& scenes;
  CompiledCache& compiled;
  JobQueue& queue;
  Jobs& jobs;
  KeptPictures& pictures;
  Sessions& sessions;
  IdempotencyKeys& keys;
  WaitSlots& waits;
  WaitSlots& streams;  // of events
  const Descriptions& descriptions;
  const Clock& clock;
  const std::atomic<bool>& is_stopping;
};

}  // namespace tilelight::server
