// SPDX-License-Identifier: Apache-2.0
// The kernels of trace_rays.h as they would be without the care for numbers: the same trees, packets and walk,
// triangles by Moeller and Trumbore in float, a fixed epsilon, nothing in double for meshes. Faster, and wrong in
// places. What walks apart keeps its care: it is a twentieth of primary rays' time and a sixth of their shadow rays'.
#pragma once

#include <cstdint>
#include <span>

#include "renderer/trace/trace_rays.h"

namespace tilelight {

void naive_closest(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<Hit> hits);
void naive_any(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<uint8_t> is_blocked);

// How many of the rays our own packets leave to be decided one by one in double: asked for the nearest hit, for any.
struct Undecided {
  int64_t closest = 0, any = 0;
};
Undecided undecided_of(const CompiledScene& scene, std::span<const BoundedRay> rays);

}  // namespace tilelight
