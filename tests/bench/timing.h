// SPDX-License-Identifier: Apache-2.0
// What the benchmarks share: seconds by the clock, medians, and ratios of two sides that were timed in turn, so that
// they hold when the machine's speed drifts.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <vector>

namespace tilelight::bench {

inline double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Time that several threads spend on one kind of work, with other work between.
class SpentTime {
 public:
  template <class Work>
  void spend(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    spent_ += std::chrono::nanoseconds(std::chrono::steady_clock::now() - start).count();
  }
  double seconds() const { return 1e-9 * static_cast<double>(spent_.load()); }

 private:
  std::atomic<int64_t> spent_ = 0;
};

// REQUIRES: at least one.
inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

struct Ratio {
  double least, middle, most;
};
// Round by round. REQUIRES: equal sizes, at least one.
inline Ratio ratio_of(const std::vector<double>& over, const std::vector<double>& under) {
  std::vector<double> all;
  for (size_t i = 0; i < under.size(); ++i) all.push_back(over[i] / under[i]);
  std::sort(all.begin(), all.end());
  return {all.front(), all[all.size() / 2], all.back()};
}

}  // namespace tilelight::bench
