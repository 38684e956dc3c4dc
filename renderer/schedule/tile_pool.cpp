// SPDX-License-Identifier: Apache-2.0
#include "renderer/schedule/tile_pool.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <latch>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "renderer/base/standard_floats.h"

namespace tilelight {
namespace {

constexpr size_t kClasses = 3;  // of Priority

double ms_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

// A source in the pool. All but `source` is guarded by the pool's mutex.
struct Entry {
  std::shared_ptr<WorkSource> source;
  bool runnable = true;  // false from `nothing_now` to wake()
  int running = 0;       // items that run now
  double used_ms = 0.0;  // thread time of the finished items, from where the class stood when the source came
  double mean_ms = 0.0;  // of a finished item, recent ones weighing more

  // Its place in the class: the time it has used, counting what it is using now as if done.
  double share_ms() const { return used_ms + running * mean_ms; }
};

// One class: tasks go before items, being few and short; items go by share.
struct ClassQueue {
  std::deque<std::function<void()>> tasks;
  std::vector<std::shared_ptr<Entry>> entries;
  // Where the least served source stood when it was last served. Who comes or wakes starts here: with a share of zero
  // it would hold the whole pool until it had caught up with the years of the others.
  double floor_ms = 0.0;
};

// What a thread does next. Destroyed without the pool's lock, since dropping the last reference to a source or a task
// runs their destructors.
struct Job {
  std::function<void()> task;
  std::shared_ptr<Entry> entry;
  uint64_t item = 0;
  std::vector<std::shared_ptr<Entry>> retired;
  bool stop = false;
  bool empty() const { return !task && !entry && retired.empty(); }
};

}  // namespace

struct TilePool::State {
  std::mutex mutex;
  std::condition_variable ready;  // there may be a job, or the pool stops
  std::array<ClassQueue, kClasses> classes;
  bool stopping = false;
  std::vector<std::jthread> threads;  // last: joined before the rest goes

  ClassQueue& queue(Priority priority) { return classes[static_cast<size_t>(priority)]; }

  // Ends all threads.
  void stop() {
    {
      const std::lock_guard lock(mutex);
      stopping = true;
    }
    ready.notify_all();
    threads.clear();  // joins
  }

  void work() {
    const StandardFloats floats;  // not those of the thread that made the pool
    for (;;) {
      const Job job = wait_for_job();
      if (job.stop) return;
      if (job.task) job.task();
      if (job.entry) run_item(job);
    }
  }

  void run_item(const Job& job) {
    const auto start = std::chrono::steady_clock::now();
    job.entry->source->run(job.item);
    const double ms = ms_since(start);
    const std::lock_guard lock(mutex);
    Entry& entry = *job.entry;
    entry.mean_ms = entry.mean_ms == 0.0 ? ms : 0.75 * entry.mean_ms + 0.25 * ms;
    entry.used_ms += ms;
    --entry.running;
  }

  Job wait_for_job() {
    std::unique_lock lock(mutex);
    for (;;) {
      Job job;
      job.stop = stopping;
      if (!stopping) find_job(job);
      if (job.stop || !job.empty()) return job;
      ready.wait(lock);
    }
  }

  // REQUIRES: mutex held.
  void find_job(Job& job) {
    for (ClassQueue& q : classes) {
      if (!q.tasks.empty()) {
        job.task = std::move(q.tasks.front());
        q.tasks.pop_front();
        return;
      }
      if (take_item(q, job)) return;
    }
  }

  // Asks the sources of a class, the least served first, until one has an item. REQUIRES: mutex held.
  bool take_item(ClassQueue& q, Job& job) {
    while (const std::shared_ptr<Entry> entry = least_served(q)) {
      const WorkSource::Next next = entry->source->take();
      if (next.offer == WorkSource::Offer::item) {
        q.floor_ms = std::max(q.floor_ms, entry->share_ms());
        ++entry->running;
        job.entry = entry;
        job.item = next.item;
        return true;
      }
      entry->runnable = false;
      if (next.offer == WorkSource::Offer::finished) {
        std::erase(q.entries, entry);
        job.retired.push_back(entry);
      }
    }
    return false;
  }

  // Null if none is runnable. Of equals the one with the fewest items running, then the one that came first.
  static std::shared_ptr<Entry> least_served(const ClassQueue& q) {
    std::shared_ptr<Entry> best;
    for (const auto& entry : q.entries) {
      if (!entry->runnable) continue;
      if (!best || std::pair(entry->share_ms(), entry->running) < std::pair(best->share_ms(), best->running))
        best = entry;
    }
    return best;
  }
};

TilePool::TilePool(int threads) : state_(std::make_unique<State>()) {
  if (threads <= 0) threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  try {
    for (int i = 0; i < threads; ++i) state_->threads.emplace_back([state = state_.get()] { state->work(); });
  } catch (...) {  // the system has no more threads: those that there are wait for work, and would for ever
    state_->stop();
    throw;
  }
}

TilePool::~TilePool() {
  state_->stop();
  // While the pool still answers: the destructor of a source or of a task may call it.
  const auto dropped = std::exchange(state_->classes, {});
}

int TilePool::thread_count() const { return static_cast<int>(state_->threads.size()); }

void TilePool::add(std::shared_ptr<WorkSource> source, Priority priority) {
  auto entry = std::make_shared<Entry>();
  entry->source = std::move(source);
  {
    const std::lock_guard lock(state_->mutex);
    ClassQueue& q = state_->queue(priority);
    entry->used_ms = q.floor_ms;
    q.entries.push_back(std::move(entry));
  }
  state_->ready.notify_all();
}

void TilePool::wake(const WorkSource* source) {
  {
    const std::lock_guard lock(state_->mutex);
    for (ClassQueue& q : state_->classes) {
      for (const auto& entry : q.entries) {
        if (entry->source.get() != source || entry->runnable) continue;
        entry->runnable = true;
        entry->used_ms = std::max(entry->used_ms, q.floor_ms);
      }
    }
  }
  state_->ready.notify_all();
}

void TilePool::post(Priority priority, std::function<void()> task) {
  {
    const std::lock_guard lock(state_->mutex);
    state_->queue(priority).tasks.push_back(std::move(task));
  }
  state_->ready.notify_one();
}

void TilePool::parallel_for(int64_t count, Priority priority, const std::function<void(int64_t)>& fn,
                            const std::atomic<bool>* stop) {
  if (count <= 0) return;
  struct Loop {
    Loop(int64_t n, const std::function<void(int64_t)>& f, const std::atomic<bool>* s)
        : count(n), left(n), body(f), stop(s) {}
    // A helper that comes after the last index was handed out touches neither `body` and `stop`, which may be gone, nor
    // `left`.
    void run() {
      const StandardFloats floats;
      // Relaxed: the counter only hands out indices; `left` orders their results before the return.
      for (int64_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;) {
        try {
          if (!has_failed.load(std::memory_order_relaxed)) {  // relaxed: it only saves work
            if (stop && stop->load(std::memory_order_relaxed)) throw Stopped{};
            body(i);
          }
        } catch (...) {
          if (!has_failed.exchange(true, std::memory_order_relaxed)) error = std::current_exception();
        }
        left.count_down();
      }
    }
    const int64_t count;
    std::atomic<int64_t> next{0};
    std::latch left;
    const std::function<void(int64_t)>& body;
    const std::atomic<bool>* const stop;
    std::atomic<bool> has_failed{false};
    std::exception_ptr error;  // written once, before `left` lets the caller read it
  };
  const auto loop = std::make_shared<Loop>(count, fn, stop);
  const int64_t helpers = std::min<int64_t>(count - 1, thread_count());
  for (int64_t i = 0; i < helpers; ++i) post(priority, [loop] { loop->run(); });
  loop->run();
  // Only for indices that some thread is running: a helper still in the queue holds none.
  loop->left.wait();
  // Taken along: a helper that is late frees the loop, but nothing that the caller reads.
  if (loop->error) std::rethrow_exception(std::exchange(loop->error, nullptr));
}

}  // namespace tilelight
