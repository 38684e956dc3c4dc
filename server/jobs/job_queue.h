// SPDX-License-Identifier: Apache-2.0
// JobQueue: admits renders or refuses them at once, starts as many as have a slot, shares identical ones in flight, and
// stops the work when its last holder leaves. Any thread may call any method; no lock is held while rendering.
#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <unordered_map>

#include "server/jobs/render_work.h"
#include "server/log.h"
#include "server/metrics.h"

namespace tilelight::server {

class JobQueue;

// A holder's share in a render: work ends when the last lease is gone.
class WorkLease {
 public:
  WorkLease() = default;
  WorkLease(std::shared_ptr<JobQueue> queue, WorkPtr work) : queue_(std::move(queue)), work_(std::move(work)) {}
  WorkLease(WorkLease&& other) noexcept = default;
  WorkLease& operator=(WorkLease&& other) noexcept;
  ~WorkLease() { release(); }

  const WorkPtr& work() const { return work_; }
  void release();

 private:
  std::shared_ptr<JobQueue> queue_;
  WorkPtr work_;
};

class JobQueue : public std::enable_shared_from_this<JobQueue> {
 public:
  struct Options {
    int max_queue = 256;
    // Renders of a class that hold a film at once. Two keep the cores busy over each other's ends; more lets a small
    // normal render overtake a large one by fair share, at the price of a film each.
    int max_running_normal = 8;
    int max_running_batch = 2;
    // Whatever their number: memory of the films of running renders, and of the scenes of all that are in the queue.
    int64_t max_film_bytes = int64_t{2} << 30;
    int64_t max_scene_bytes = int64_t{1} << 30;
  };
  struct Counts {
    int queued = 0, running = 0;
  };

  // Owned by shared_ptr: tasks on the pool hold it. The references must outlive it.
  static std::shared_ptr<JobQueue> make(TilePool& pool, std::shared_ptr<CompiledCache> compiled, Metrics& metrics,
                                        const Log& log, const Clock& clock, Options options);

  // Errors: queue_full, stopping.
  Result<WorkLease> submit(RenderRequest request);
  Counts counts() const;

  // Admits nothing more and cancels what has not started; waits up to grace_ms for the running renders, then cancels
  // them and waits for their ends.
  void drain(double grace_ms);

 private:
  friend class WorkLease;
  JobQueue(TilePool& pool, std::shared_ptr<CompiledCache> compiled, Metrics& metrics, const Log& log,
           const Clock& clock, Options options);

  // One step each of a render's way; called without the lock.
  void start(const WorkPtr& work);
  void begin_render(const WorkPtr& work, const CompiledPtr& compiled);
  void note_pass(const WorkPtr& work);
  void conclude(const WorkPtr& work);
  void end(const WorkPtr& work, JobState state, std::string error);
  void fail_work(const WorkPtr& work, std::string_view cause);

  void release(const WorkPtr& work);
  void start_next();

  struct Lane {  // of a priority class
    std::deque<WorkPtr> queued;
    int running = 0;
    int max_running = 0;
  };
  int queued_count() const;               // REQUIRES: mutex_
  bool has_slot(const Lane& lane) const;  // for the first of its queue; REQUIRES: mutex_
  Lane& lane(Priority priority) { return lanes_[priority == Priority::batch ? 1 : 0]; }

  TilePool& pool_;
  const std::shared_ptr<CompiledCache> compiled_;
  Metrics& metrics_;
  const Log& log_;
  const Clock& clock_;
  const Options options_;

  mutable std::mutex mutex_;  // guards the rest
  std::condition_variable idle_;
  Lane lanes_[2];
  std::set<WorkPtr> running_;                           // keeps them alive until they have ended
  std::unordered_map<std::string, WorkPtr> in_flight_;  // by key: what a new request may join
  std::unordered_map<const RenderWork*, int> holders_;
  std::unordered_map<const RenderWork*, Steady::time_point> step_start_;
  int64_t film_bytes_ = 0, scene_bytes_ = 0;
  bool is_stopping_ = false;
};

}  // namespace tilelight::server
