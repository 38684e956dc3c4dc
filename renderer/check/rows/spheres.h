// SPDX-License-Identifier: Apache-2.0
// The runs of group S that have a file of their own.
#pragma once

#include "renderer/check/check.h"

namespace tilelight::check {

// spheres_far.cpp: where the numbers are large beside what is looked at.
Outcome far_ball(const Context& context);
Outcome farther_ball(const Context& context);
Outcome farthest_ball(const Context& context);
Outcome planet(const Context& context);
Outcome speck_far_away(const Context& context);

// spheres_thin.cpp: where something is thin beside its neighbour.
Outcome glass_shell(const Context& context);
Outcome dust(const Context& context);
Outcome needle_ellipsoid(const Context& context);

}  // namespace tilelight::check
