// SPDX-License-Identifier: Apache-2.0
// The part of a picture's error that is the rounding of its arithmetic, told from a few pixels.
#pragma once

#include <optional>

#include "renderer/compile/compile.h"

namespace tilelight {

// The root mean square, over the channels of 64 pixels spread over the image, of the difference between their first
// samples and the same traced by the reference in double, both as displayed. None where the reference does not draw
// the same (triangles for spheres, other shadings and methods), or where a million triangles would have to be set up.
std::optional<double> find_rounding(const Scene& scene, const CompiledScene& compiled, const ViewPlan& plan);

}  // namespace tilelight
