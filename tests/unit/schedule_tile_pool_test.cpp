// SPDX-License-Identifier: Apache-2.0
// No test waits by the clock: threads meet at latches and barriers.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <barrier>
#include <chrono>
#include <latch>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "renderer/schedule/tile_pool.h"
#include "tests/unit/host_floats.h"

namespace tilelight {
namespace {

using Body = std::function<void(uint64_t)>;

// Hands out items 0 .. count-1, then finishes.
class Counted : public WorkSource {
 public:
  Counted(uint64_t count, Body body) : count_(count), body_(std::move(body)) {}
  Next take() override {
    if (next_ == count_) return {Offer::finished, 0};
    return {Offer::item, next_++};
  }
  void run(uint64_t item) override { body_(item); }

 private:
  uint64_t next_ = 0;
  const uint64_t count_;
  const Body body_;
};

// Holds every thread of a pool from construction to release(), so that what is added meanwhile starts together.
class Gate {
 public:
  explicit Gate(TilePool& pool) : arrived_(pool.thread_count()) {
    for (int i = 0; i < pool.thread_count(); ++i) {
      pool.post(Priority::interactive, [this] {
        arrived_.count_down();
        open_.wait();
        left_.fetch_add(1);
      });
    }
    threads_ = pool.thread_count();
    arrived_.wait();
  }
  void release() { open_.count_down(); }
  ~Gate() {
    while (left_.load() < threads_) std::this_thread::yield();
  }

 private:
  std::latch arrived_, open_{1};
  std::atomic<int> left_{0};
  int threads_ = 0;
};

class Log {
 public:
  void add(char who) {
    const std::lock_guard lock(mutex_);
    text_ += who;
  }
  std::string text() const {
    const std::lock_guard lock(mutex_);
    return text_;
  }

 private:
  mutable std::mutex mutex_;
  std::string text_;
};

double spin_ms(double ms) {
  const auto start = std::chrono::steady_clock::now();
  double passed = 0.0;
  while (passed < ms)
    passed = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return passed;
}

TEST(TilePool, HasAsManyThreadsAsAskedOrAsTheMachine) {
  EXPECT_EQ(TilePool(3).thread_count(), 3);
  EXPECT_GE(TilePool().thread_count(), 1);
}

TEST(TilePool, RunsEveryItemOnce) {
  constexpr int kItems = 5000;
  std::vector<std::atomic<int>> runs(kItems);
  std::latch done(kItems);
  TilePool pool(4);
  pool.add(std::make_shared<Counted>(kItems,
                                     [&](uint64_t i) {
                                       runs[i].fetch_add(1);
                                       done.count_down();
                                     }),
           Priority::normal);
  done.wait();
  for (const auto& count : runs) EXPECT_EQ(count.load(), 1);
}

TEST(TilePool, RunsItemsOfOneSourceAtTheSameTime) {
  std::barrier meet(3);  // passed only if three threads are inside at once
  std::latch done(9);
  TilePool pool(3);
  pool.add(std::make_shared<Counted>(9,
                                     [&](uint64_t) {
                                       meet.arrive_and_wait();
                                       done.count_down();
                                     }),
           Priority::batch);
  done.wait();
}

TEST(TilePool, HigherClassGoesFirstWhateverTheOrderOfArrival) {
  Log log;
  std::latch done(9);
  TilePool pool(1);
  auto source = [&](char who) {
    return std::make_shared<Counted>(2, [&, who](uint64_t) { log.add(who), done.count_down(); });
  };
  auto task = [&](char who) { return [&, who] { log.add(who), done.count_down(); }; };
  Gate gate(pool);
  pool.add(source('b'), Priority::batch);
  pool.post(Priority::batch, task('B'));
  pool.add(source('n'), Priority::normal);
  pool.post(Priority::normal, task('N'));
  pool.add(source('i'), Priority::interactive);
  pool.post(Priority::interactive, task('I'));
  gate.release();
  done.wait();
  EXPECT_EQ(log.text(), "IiiNnnBbb");
}

TEST(TilePool, InteractiveWorkOvertakesARunningFrameAfterOneItem) {
  Log log;
  std::latch done(11);
  TilePool pool(1);
  auto thumbnail = std::make_shared<Counted>(1, [&](uint64_t) { log.add('t'), done.count_down(); });
  auto frame = std::make_shared<Counted>(10, [&](uint64_t item) {
    log.add('f'), done.count_down();
    if (item == 3) pool.add(thumbnail, Priority::interactive);
  });
  pool.add(frame, Priority::batch);
  done.wait();
  EXPECT_EQ(log.text(), "fffftffffff");
}

TEST(TilePool, SharesTimeAndNotItemsInsideAClass) {
  double used[2] = {0.0, 0.0}, longest = 0.0, worst_gap = 0.0;
  std::latch done(1);
  uint64_t short_items = 0;
  {
    TilePool pool(1);
    auto source = [&](int who, double ms, uint64_t count) {
      return std::make_shared<Counted>(count, [&, who, ms, count](uint64_t item) {
        const double spent = spin_ms(ms);
        used[who] += spent;
        longest = std::max(longest, spent);
        if (who == 0) worst_gap = std::max(worst_gap, std::abs(used[0] - used[1]));
        if (who == 1) ++short_items;
        if (who == 0 && item + 1 == count) done.count_down();
      });
    };
    Gate gate(pool);
    pool.add(source(0, 4.0, 20), Priority::normal);
    pool.add(source(1, 1.0, ~0ull), Priority::normal);
    gate.release();
    done.wait();
  }
  EXPECT_LE(worst_gap, 2.0 * longest + 1.0);
  EXPECT_GT(short_items, 25u);  // four times as many as the 20 long ones, less what a busy machine takes
}

TEST(TilePool, ANewcomerSharesAtOnceAndDoesNotStarveTheOthers) {
  Log log;
  std::latch done(1);
  TilePool pool(1);
  auto body = [&](char who) {
    return [&, who](uint64_t) {
      log.add(who);
      spin_ms(1.0);
    };
  };
  auto newcomer = std::make_shared<Counted>(20, body('n'));
  auto veteran = std::make_shared<Counted>(60, [&, run = body('v')](uint64_t item) {
    if (item == 30) pool.add(newcomer, Priority::normal);
    run(item);
    if (item == 59) done.count_down();
  });
  pool.add(veteran, Priority::normal);
  done.wait();
  const std::string order = log.text();
  EXPECT_EQ(order.find('n'), 31u);
  const std::string after = order.substr(31, 16);
  EXPECT_GE(std::count(after.begin(), after.end(), 'v'), 3) << order;
  EXPECT_GE(std::count(after.begin(), after.end(), 'n'), 3) << order;
}

// Has items only when it is given some.
class Fed : public WorkSource {
 public:
  explicit Fed(Body body) : body_(std::move(body)) {}
  Next take() override {
    const std::lock_guard lock(mutex_);
    if (left_ > 0) return {Offer::item, static_cast<uint64_t>(left_--)};
    return {closed_ ? Offer::finished : Offer::nothing_now, 0};
  }
  void run(uint64_t item) override { body_(item); }
  void feed(int items) {
    const std::lock_guard lock(mutex_);
    left_ += items;
  }
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }

 private:
  std::mutex mutex_;
  int left_ = 0;
  bool closed_ = false;
  const Body body_;
};

TEST(TilePool, AsksASourceAgainWhenItIsWoken) {
  for (int round = 0; round < 100; ++round) {
    std::latch done(6);
    TilePool pool(2);
    auto source = std::make_shared<Fed>([&](uint64_t) { done.count_down(); });
    pool.add(source, Priority::normal);
    source->feed(1);
    pool.wake(source.get());
    source->feed(5);
    pool.wake(source.get());
    done.wait();
  }
}

TEST(TilePool, AnItemMayWakeItsOwnSource) {
  std::latch done(50);
  TilePool pool(2);
  Fed* self = nullptr;
  int items = 0;  // only one item exists at a time, as each but the last feeds one
  auto source = std::make_shared<Fed>([&](uint64_t) {
    if (++items < 50) {
      self->feed(1);
      pool.wake(self);
    }
    done.count_down();
  });
  self = source.get();
  source->feed(1);
  pool.add(source, Priority::normal);
  done.wait();
}

TEST(TilePool, ForgetsAFinishedSource) {
  std::latch done(10), gone(1);
  TilePool pool(2);
  class Mortal : public Counted {
   public:
    Mortal(uint64_t count, Body body, std::latch& gone) : Counted(count, std::move(body)), gone_(gone) {}
    ~Mortal() override { gone_.count_down(); }

   private:
    std::latch& gone_;
  };
  pool.add(std::make_shared<Mortal>(
               10, [&](uint64_t) { done.count_down(); }, gone),
           Priority::normal);
  done.wait();
  gone.wait();
}

TEST(TilePool, TasksReturnTheirResultOrTheirException) {
  TilePool pool(2);
  EXPECT_EQ(pool.submit(Priority::normal, [] { return 42; }).get(), 42);
  EXPECT_THROW(pool.submit(Priority::batch, []() -> int { throw std::runtime_error("no"); }).get(), std::runtime_error);
}

TEST(TilePool, LoopRunsEveryIndexOnceAndReturnsAfterTheLast) {
  for (int threads : {1, 2, 5}) {
    TilePool pool(threads);
    for (int64_t count : {0, 1, 2, 1000}) {
      std::vector<int> runs(static_cast<size_t>(count));  // plain ints: the return must order the writes
      pool.parallel_for(count, Priority::normal, [&](int64_t i) { ++runs[static_cast<size_t>(i)]; });
      EXPECT_EQ(std::count(runs.begin(), runs.end(), 1), count);
    }
  }
}

TEST(TilePool, LoopUsesIdleThreads) {
  TilePool pool(2);
  std::barrier meet(3);  // the caller and both threads
  pool.parallel_for(3, Priority::normal, [&](int64_t) { meet.arrive_and_wait(); });
}

TEST(TilePool, LoopReturnsThoughEveryThreadIsBusy) {
  TilePool pool(2);
  Gate gate(pool);
  int64_t sum = 0;
  pool.parallel_for(100, Priority::batch, [&](int64_t i) { sum += i; });
  EXPECT_EQ(sum, 4950);
  gate.release();
}

TEST(TilePool, LoopsNestOnPoolThreadsWithoutDeadlock) {
  TilePool pool(2);
  std::atomic<int> leaves{0};
  std::vector<std::future<void>> outer;
  for (int t = 0; t < 6; ++t) {
    outer.push_back(pool.submit(Priority::normal, [&] {
      pool.parallel_for(8, Priority::normal,
                        [&](int64_t) { pool.parallel_for(8, Priority::batch, [&](int64_t) { leaves.fetch_add(1); }); });
    }));
  }
  for (auto& future : outer) future.get();
  EXPECT_EQ(leaves.load(), 6 * 8 * 8);
}

TEST(TilePool, DestructionFinishesWhatRunsAndDropsTheRest) {
  std::atomic<int> started{0}, finished{0};
  std::future<void> behind;
  auto endless = std::make_shared<Counted>(~0ull, [&](uint64_t) {
    started.fetch_add(1);
    std::this_thread::yield();
    finished.fetch_add(1);
  });
  {
    TilePool pool(2);
    pool.add(endless, Priority::normal);
    while (started.load() == 0) std::this_thread::yield();
    behind = pool.submit(Priority::batch, [] {});
  }
  EXPECT_EQ(started.load(), finished.load());
  EXPECT_EQ(endless.use_count(), 1);
  try {
    behind.get();
    ADD_FAILURE() << "a batch task ran before normal work was done";
  } catch (const std::future_error& error) {
    EXPECT_EQ(error.code(), std::future_errc::broken_promise);
  }
}

TEST(TilePool, ComputesByTheStandardWhateverItsMakerHasSet) {
  const volatile double one = 1.0, three = 3.0;
  const double nearest = one / three;
  test::on_host(test::Host::upwards, [&] {
    TilePool pool(2);
    EXPECT_EQ(pool.submit(Priority::normal, [&] { return one / three; }).get(), nearest);
    std::vector<double> thirds(64);  // on the pool's threads and on this one
    pool.parallel_for(64, Priority::normal, [&](int64_t i) { thirds[static_cast<size_t>(i)] = one / three; });
    EXPECT_EQ(thirds, std::vector<double>(64, nearest));
    EXPECT_GT(one / three, nearest) << "the host gets its own back";
  });
}

TEST(TilePool, StandsManyThreadsAddingWakingAndWaiting) {
  std::latch done(4 * 50 * 20);
  TilePool pool(3);
  {
    std::vector<std::jthread> clients;
    for (int c = 0; c < 4; ++c) {
      clients.emplace_back([&, c] {
        for (int round = 0; round < 50; ++round) {
          auto source = std::make_shared<Fed>([&](uint64_t) { done.count_down(); });
          pool.add(source, static_cast<Priority>((c + round) % 3));
          for (int i = 0; i < 20; ++i) {
            source->feed(1);
            pool.wake(source.get());
          }
          source->close();
          pool.wake(source.get());
        }
      });
    }
  }
  done.wait();
}

TEST(TilePool, HandsOnWhatALoopThrowsOnceNoThreadIsInItAnyMore) {
  TilePool pool(3);
  for (const int64_t bad : {0, 7, 499}) {
    std::atomic<int> inside{0}, done{0};
    const auto body = [&](int64_t i) {
      ++inside;
      const bool is_bad = i == bad;
      if (!is_bad) ++done;
      --inside;
      if (is_bad) throw std::runtime_error("index " + std::to_string(i));
    };
    try {
      pool.parallel_for(500, Priority::normal, body);
      FAIL() << "it should have thrown";
    } catch (const std::runtime_error& e) {
      EXPECT_EQ(e.what(), "index " + std::to_string(bad));
    }
    EXPECT_EQ(inside, 0);
    EXPECT_LE(done, 499);
  }
  std::atomic<bool> stop{true};
  EXPECT_THROW(pool.parallel_for(
                   10, Priority::normal, [](int64_t) { FAIL(); }, &stop),
               Stopped);
}

}  // namespace
}  // namespace tilelight
