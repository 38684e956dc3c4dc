// SPDX-License-Identifier: Apache-2.0
// Stopwatch: milliseconds since it was made. For plans, which say what making them took.
#pragma once

#include <chrono>

namespace tilelight {

class Stopwatch {
 public:
  double ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace tilelight
