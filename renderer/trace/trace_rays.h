// SPDX-License-Identifier: Apache-2.0
// Rays against the compiled scene, a batch at a time: the only code that is compiled for several instruction sets. One
// dispatched call a batch; only what follows a ray alone (tinted shadows, hidden surfaces) comes one by one. Every
// ray's answer depends on that ray alone. Any thread.
#pragma once

#include <span>
#include <vector>

#include "renderer/compile/compiled_scene.h"
#include "renderer/shade/ray.h"

namespace tilelight {

// hits[i] = the nearest hit of rays[i], ties to the lowest (rank, primitive). REQUIRES: equal sizes.
void trace_closest(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<Hit> hits);

// is_blocked[i] = whether anything lies before rays[i].t_max. REQUIRES: equal sizes.
void trace_any(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<uint8_t> is_blocked);

// The nearest hit with one body alone.
Hit trace_body(const CompiledScene& scene, uint32_t body, const Ray& ray);

// All surfaces that lie, within rounding, in one place with a point of the body `owner`, where the line through it
// meets them; t counts from there. In no order.
void find_surfaces(const CompiledScene& scene, const Vec3& place, const Vec3& direction, uint32_t owner,
                   std::vector<Hit>& found);

}  // namespace tilelight
