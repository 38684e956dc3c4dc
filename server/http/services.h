// SPDX-License-Identifier: Apache-2.0
// Services: what the handlers work with. References into the App; any thread.
#pragma once

#include <atomic>

#include "server/config.h"
#include "server/http/message.h"
#include "server/jobs/idempotency.h"
#include "server/jobs/jobs.h"
#include "server/sessions/sessions.h"

namespace tilelight::server {

// The budget of workers that may wait for something else than the processor, so that waiting never takes the workers
// that answer others.
class WaitSlots {
 public:
  explicit WaitSlots(int count) : free_(count) {}

  class Slot {
   public:
    explicit Slot(WaitSlots* owner) : owner_(owner) {}
    Slot(Slot&& other) noexcept : owner_(std::exchange(other.owner_, nullptr)) {}
    Slot& operator=(Slot&&) = delete;
    ~Slot() {
      if (owner_) owner_->free_.fetch_add(1, std::memory_order_relaxed);
    }

   private:
    WaitSlots* owner_;
  };
  // A slot, or 503.
  ::tl::expected<Slot, Problem> take();
  int free() const { return free_.load(std::memory_order_relaxed); }

 private:
  std::atomic<int> free_;  // relaxed: a count and nothing else
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
  Sessions& sessions;
  IdempotencyKeys& keys;
  WaitSlots& waits;
  const std::atomic<bool>& is_stopping;
};

}  // namespace tilelight::server
