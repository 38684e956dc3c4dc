// SPDX-License-Identifier: Apache-2.0
// Normals of triangles of any size, anywhere; and when a triangle has none. Pure; any thread.
#pragma once

#include "renderer/base/vec.h"

namespace tilelight {

// The unit normal of a triangle by the right-hand rule, or zero if its height is lost in the rounding of its
// coordinates.
Vec3 geometric_normal(const Vec3& a, const Vec3& b, const Vec3& c);

// v / |v| for lengths from the smallest subnormal to the largest double; zero for a zero or non-finite vector.
Vec3 unit_or_zero(const Vec3& v);

}  // namespace tilelight
