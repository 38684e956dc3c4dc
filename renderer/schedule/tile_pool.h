// SPDX-License-Identifier: Apache-2.0
// TilePool: the threads of the process. Renders own no threads: they are sources that hand out work items; the pool
// gives the next item of the runnable source with the highest priority to the next free thread, by fair share (least
// time used so far) inside a class, so a thumbnail waits for an 8K frame by no more than one item's time. Parsing,
// BVH building and encoding run here as tasks, so cores are never over-subscribed.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>

namespace tilelight {

enum class Priority { interactive, normal, batch };

// Something that hands out work items. Owned by shared_ptr; the pool keeps it alive while an item of it runs.
class WorkSource {
 public:
  virtual ~WorkSource() = default;

  enum class Offer { item, nothing_now, finished };
  struct Next {
    Offer offer = Offer::nothing_now;
    uint64_t item = 0;
  };
  // Takes the next item. Called by pool threads one at a time under the pool's lock: must be quick, must not call the
  // pool. After `finished` the pool forgets the source; after `nothing_now` it asks again on wake().
  virtual Next take() = 0;

  // Runs an item on a pool thread; no lock is held; several items of one source run at once. Must not throw.
  virtual void run(uint64_t item) = 0;
};

// Thrown out of work that was asked to stop.
struct Stopped {};

class TilePool {
 public:
  // threads = 0: one a hardware thread.
  explicit TilePool(int threads = 0);
  ~TilePool();  // finishes the items that run, drops the rest
  TilePool(const TilePool&) = delete;
  TilePool& operator=(const TilePool&) = delete;

  int thread_count() const;

  void add(std::shared_ptr<WorkSource> source, Priority priority);
  // The source may have items again. Any thread, also from inside run().
  void wake(const WorkSource* source);

  // Runs fn on a pool thread. The future carries its result or its exception.
  template <class Fn>
  auto submit(Priority priority, Fn fn) -> std::future<decltype(fn())> {
    auto task = std::make_shared<std::packaged_task<decltype(fn())()>>(std::move(fn));
    auto future = task->get_future();
    post(priority, [task] { (*task)(); });
    return future;
  }
  void post(Priority priority, std::function<void()> task);

  // Calls fn(i) for i in [0, count), on this thread and on idle pool threads; returns when all are done. May be called
  // from a pool thread (it never waits for a queue). Once fn throws, indices not begun are left out, and the first
  // exception comes out here. Once `stop` is set it is as if fn had thrown Stopped; null: nobody sets it.
  void parallel_for(int64_t count, Priority priority, const std::function<void(int64_t)>& fn,
                    const std::atomic<bool>* stop = nullptr);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tilelight
