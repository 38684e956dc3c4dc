// SPDX-License-Identifier: Apache-2.0
// Metrics: counters, gauges and one histogram, printed in Prometheus' text format (0.0.4). A leaf; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace tilelight::server {

class Metrics {
 public:
  // Adds to a counter. `labels` is the inside of the braces, e.g. `state="done"`; empty for none. Takes no memory where
  // something was added before.
  void add(std::string_view name, std::string_view labels, double amount = 1.0);
  double value(std::string_view name, std::string_view labels) const;  // 0 where nothing was added

  void observe_request_ms(double ms);

  // A number read when the metrics are: of a queue, a cache, the process. The function must stay callable while this
  // lives. A name that ends in _total is typed as a counter.
  void gauge(std::string_view name, std::string_view help, std::function<double()> read);

  std::string prometheus_text() const;

 private:
  static constexpr std::array<double, 11> kBucketsMs = {1, 2.5, 5, 10, 25, 50, 100, 250, 1000, 5000, 30000};
  struct Gauge {
    std::string name, help;
    std::function<double()> read;
  };

  using Cells = std::map<std::string, double, std::less<>>;  // labels -> value

  mutable std::mutex mutex_;                            // guards all below; never held while a gauge is read
  std::map<std::string, Cells, std::less<>> counters_;  // by name
  std::vector<Gauge> gauges_;
  std::array<uint64_t, kBucketsMs.size() + 1> requests_{};  // the last: longer than all
  double request_sum_ms_ = 0.0;
};

}  // namespace tilelight::server
