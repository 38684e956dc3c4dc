// SPDX-License-Identifier: Apache-2.0
// The kernels of trace_rays.h as they would be without the care for numbers: the same trees and the same walk,
// triangles by Moeller and Trumbore in float, a fixed epsilon, nothing in double after the leaf. Faster, and wrong in
// places.
#pragma once

#include <span>

#include "renderer/trace/trace_rays.h"

namespace tilelight {

void naive_closest(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<Hit> hits);
void naive_any(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<uint8_t> is_blocked);

}  // namespace tilelight
