// SPDX-License-Identifier: Apache-2.0
// What was left out would have cost this: the words of LeftOut::cost. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "renderer/compile/plan.h"

namespace tilelight {

// "232 bytes", "1.2 MiB".
std::string bytes_text(int64_t bytes);

// Of something that happens at most once at every place where a ray from the eye hits: "up to 15 million shadow rays at
// first hits". At every sample of the view where their number is known, else at one sample of every pixel.
std::string first_hits_text(const View& view, int64_t times, const std::string& what);

// The share of a frame's time that a kernel with one more feature takes; none where it is the same kernel. Medians of
// bench_plan over the scenes of web/scenes.
std::optional<std::string> kernel_cost_text(const FeatureSet& features, Feature more);

}  // namespace tilelight
