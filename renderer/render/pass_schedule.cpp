// SPDX-License-Identifier: Apache-2.0
#include "renderer/render/pass_schedule.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "renderer/base/elementary.h"

namespace tilelight {
namespace {

// Before samples go where the error is, every pixel takes as many as tell its error.
constexpr double kFirstForAll = 4.0;

// Samples for each one there is, to bring the error down to `rmse`: it falls with n^-0.75, and faster where samples go
// where the error is.
double growth(double error, double rmse, bool adaptive) {
  return elementary::pow(error / rmse, adaptive ? 2.0 / 3.0 : 4.0 / 3.0);
}

PassSchedule::Next over(const char* stop) { return {.samples = 0.0, .stop = stop}; }

}  // namespace

PassSchedule::PassSchedule(const RenderSpec& spec, std::vector<double> before)
    : before_(std::move(before)),
      replay_(spec.passes),
      samples_(spec.samples.value_or(spec.passes.empty() ? 16 : std::numeric_limits<int>::max())),
      adaptive_(spec.adaptive),
      rmse_(spec.rmse.value_or(0.0)),
      time_ms_(spec.time_ms.value_or(std::numeric_limits<double>::infinity())) {}

bool PassSchedule::is_for_all(const Standing& standing, double samples) const {
  return samples == std::floor(samples) && !(adaptive_ && standing.spp >= kFirstForAll);
}

PassSchedule::Next PassSchedule::pass_of(const Standing& standing, double samples) const {
  const bool is_sketch = standing.passes == 0 && samples == kSketchSamples;
  return {
      .samples = samples, .for_all = is_sketch || is_for_all(standing, samples), .is_sketch = is_sketch, .stop = {}};
}

PassSchedule::Next PassSchedule::replay(const Standing& standing) const {
  if (standing.passes > 0 && standing.elapsed_ms >= time_ms_) return over("time");
  return pass_of(standing, std::min(replay_[static_cast<size_t>(standing.passes)], samples_ - standing.spp));
}

PassSchedule::Next PassSchedule::next(const Standing& standing) const {
  if (standing.passes < static_cast<int>(before_.size())) {
    return pass_of(standing, before_[static_cast<size_t>(standing.passes)]);
  }
  // A pass that goes where the error is gives whole cells their samples, and leaves less than the next one takes.
  const double kLeast = std::max(1.0, standing.spp / 4.0) / 64.0;
  if (!replay_.empty() && standing.passes >= static_cast<int>(replay_.size())) return over("passes");
  if (samples_ - standing.spp < kLeast) return over("samples");
  if (rmse_ > 0.0 && standing.rmse <= rmse_ && standing.spp >= kFirstForAll) return over("rmse");
  if (!replay_.empty()) return replay(standing);
  if (standing.spp < 1.0) {
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    if (standing.passes == 0) return pass_of(standing, time_ms_ < kInfinite ? kSketchSamples : 1.0);
    return standing.elapsed_ms < time_ms_ ? pass_of(standing, 1.0) : over("time");
  }

  // Doubling keeps the blocks of a pixel's sequence whole: with a few samples more its mean is hardly better.
  const bool is_spent = adaptive_ && standing.spp >= kFirstForAll;
  double wanted = standing.spp;
  if (is_spent && rmse_ > 0.0 && standing.rmse < std::numeric_limits<double>::infinity()) {
    // Short passes: each sees better than the one before where the error is, and none goes far beyond the goal.
    const double eighths = std::ceil(8.0 * (growth(standing.rmse, rmse_, true) - 1.0));
    wanted *= std::clamp(eighths, 1.0, 4.0) / 8.0;
  }
  wanted = std::min(wanted, samples_ - standing.spp);
  // What is left when less than this remains is too little to be worth a pass.
  const double left_ms = time_ms_ - standing.elapsed_ms;
  if (left_ms < std::max(3.0, 0.02 * time_ms_)) return over("time");
  // Passes differ in what a sample costs: where the error is, it is dearer.
  const auto fitting = [&](bool for_all) {
    return (!for_all && standing.was_for_all ? 0.35 : 0.8) * left_ms / standing.ms_per_sample;
  };
  if (fitting(!is_spent) < wanted) {
    // No whole number, so that a replay sends it where the error is, as is done here.
    wanted = (std::floor(std::min(wanted, fitting(false)) / kLeast) - 0.5) * kLeast;
    if (wanted < kLeast) return over("time");
  }
  return pass_of(standing, wanted);
}

double PassSchedule::expected_samples(const Standing& standing) const {
  double expected = replay_.empty() ? samples_ : std::accumulate(replay_.begin(), replay_.end(), 0.0);
  expected = std::min(expected, samples_);
  if (rmse_ > 0.0 && standing.rmse < std::numeric_limits<double>::infinity())
    expected = std::min(expected, standing.spp * std::max(1.0, growth(standing.rmse, rmse_, adaptive_)));
  return expected;
}

}  // namespace tilelight
