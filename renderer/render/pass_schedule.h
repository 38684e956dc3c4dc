// SPDX-License-Identifier: Apache-2.0
// How much the next pass takes: 1, 1, 2, 4, 8, ... samples a pixel up to the view's stop rules, or the list of an exact
// replay. Plain value, no clock inside: times come in as numbers.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace tilelight {

// How far a render is.
struct Standing {
  int passes = 0;
  double spp = 0.0;                                       // samples a pixel so far: the mean over pixels
  double elapsed_ms = 0.0;                                // since its start
  double ms_per_sample = 0.0;                             // a pixel's; by its last pass
  bool was_for_all = true;                                // that pass gave every pixel as many
  double rmse = std::numeric_limits<double>::infinity();  // the upper end of the estimate
};

// A first pass that takes one pixel of every cell, where time is short: the picture in a sixteenth of its pixels, in
// case the time does not suffice for all. It is no part of the film. Samples a pixel, as passes count it.
inline constexpr double kSketchSamples = 1.0 / 16.0;

class PassSchedule {
 public:
  // before: passes that come first, whatever the rules. The rules speak of the whole.
  explicit PassSchedule(const RenderSpec& spec, std::vector<double> before = {});

  struct Next {
    // A pixel's; the mean over pixels where it is not for all alike. 0: the render is over.
    double samples = 0.0;
    bool for_all = true;  // every pixel takes as many; else they go where the error is
    bool is_sketch = false;
    std::string stop;  // once it is over: "samples", "rmse", "time" or "passes"
  };
  // The first pass always runs, by the time rule as a sketch. That rule cuts passes to what fits; those of a replay
  // stay whole.
  Next next(const Standing& standing) const;

  // What the render takes in all, a pixel: by its rules on samples and, once the error is known, on rmse.
  double expected_samples(const Standing& standing) const;

 private:
  Next pass_of(const Standing& standing, double samples) const;
  Next replay(const Standing& standing) const;  // REQUIRES: a pass of the replay is left
  bool is_for_all(const Standing& standing, double samples) const;

  std::vector<double> before_, replay_;
  double samples_;
  bool adaptive_;
  double rmse_;     // 0 without the rule
  double time_ms_;  // infinite without the rule
};

}  // namespace tilelight
