// SPDX-License-Identifier: Apache-2.0
// Primary rays, many side by side: those of eye_ray to the last bit. Any thread.
#pragma once

#include <span>

#include "renderer/compile/eye.h"
#include "renderer/shade/ray.h"
#include "renderer/trace/pixel_filter.h"

namespace tilelight {

// rays[i] passes through point i; its t_max and what it has left stay as they are. REQUIRES: equal sizes.
void aim_eye_rays(const Eye& eye, const ImagePoints& points, std::span<BoundedRay> rays);

}  // namespace tilelight
