// SPDX-License-Identifier: Apache-2.0
// Primary rays, many side by side: those of eye_ray to the last bit. Any thread.
#pragma once

#include <span>

#include "renderer/compile/eye.h"
#include "renderer/shade/ray.h"

namespace tilelight {

// rays[i] passes through points[i] of the image, pixels from its top left corner; its t_max and what it has left stay
// as they are. REQUIRES: equal sizes.
void aim_eye_rays(const Eye& eye, std::span<const Vec2> points, std::span<BoundedRay> rays);

}  // namespace tilelight
