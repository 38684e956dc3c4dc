// SPDX-License-Identifier: Apache-2.0
// KeptFilms: which done renders can still be refined. Their films are kept for some minutes and within a number of
// bytes; the oldest are dropped first. Any thread.
#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "server/jobs/render_work.h"

namespace tilelight::server {

class KeptFilms {
 public:
  struct Options {
    int64_t max_bytes = int64_t{1} << 30;
    double keep_ms = 300'000.0;
  };
  KeptFilms(const Clock& clock, Options options) : clock_(clock), options_(options) {}

  // Of a work that has ended. The second time changes nothing: jobs may share a work.
  void add(const WorkPtr& work);
  // Drops what is too old and, beyond the budget, the oldest. add() does; this is for when nobody comes.
  void drop_old();
  int64_t bytes() const;

 private:
  struct Entry {
    std::weak_ptr<RenderWork> work;  // its jobs hold it; forgotten ones take their film along
    double since_ms;
  };

  const Clock& clock_;
  const Options options_;
  mutable std::mutex mutex_;   // guards the rest
  std::deque<Entry> entries_;  // oldest first
};

}  // namespace tilelight::server
