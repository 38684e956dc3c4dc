// SPDX-License-Identifier: Apache-2.0
#include "renderer/render/pass_schedule.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tilelight {

PassSchedule::PassSchedule(const RenderSpec& spec)
    : replay_(spec.passes),
      samples_(spec.passes.empty() ? spec.samples.value_or(16)
                                   : std::min(spec.samples.value_or(std::numeric_limits<int>::max()),
                                              std::accumulate(spec.passes.begin(), spec.passes.end(), 0))),
      time_ms_(spec.time_ms.value_or(std::numeric_limits<double>::infinity())) {}

PassSchedule::Next PassSchedule::next(int passes_done, int done, double elapsed_ms, double ms_per_sample) const {
  if (!replay_.empty()) {
    if (passes_done >= static_cast<int>(replay_.size())) return {0, "passes"};
    if (done >= samples_) return {0, "samples"};
    if (done > 0 && elapsed_ms >= time_ms_) return {0, "time"};
    return {std::min(replay_[static_cast<size_t>(passes_done)], samples_ - done), {}};
  }
  if (done >= samples_) return {0, "samples"};
  int wanted = std::min(std::max(1, done), samples_ - done);
  if (done > 0) {
    const double fitting = (time_ms_ - elapsed_ms) / ms_per_sample;
    if (fitting < 1.0) return {0, "time"};
    if (fitting < wanted) wanted = static_cast<int>(fitting);
  }
  return {wanted, {}};
}

}  // namespace tilelight
