// SPDX-License-Identifier: Apache-2.0
// How many samples the next pass takes: 1, 1, 2, 4, 8, ... up to the view's stop rules, or the list of an exact replay.
// Plain value, no clock inside: times come in as numbers.
#pragma once

#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace tilelight {

class PassSchedule {
 public:
  explicit PassSchedule(const RenderSpec& spec);

  struct Next {
    int samples = 0;   // 0: the render is over
    std::string stop;  // then: "samples", "time" or "passes"
  };
  // done: samples a pixel in whole passes so far. elapsed_ms, ms_per_sample: of this render, for the time rule, which
  // cuts a pass to what fits (a replay's passes stay whole); the first pass always runs.
  Next next(int passes_done, int done, double elapsed_ms, double ms_per_sample) const;

  int samples() const { return samples_; }  // a pixel at most

 private:
  std::vector<int> replay_;
  int samples_;
  double time_ms_;  // infinite without a time rule
};

}  // namespace tilelight
