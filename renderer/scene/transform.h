// SPDX-License-Identifier: Apache-2.0
// The user's transform of an object, composed in double from its parts. Pure but for the problems it reports.
#pragma once

#include "renderer/base/vec.h"
#include "renderer/scene/document.h"
#include "renderer/scene/problems.h"
#include "renderer/scene/scene.h"

namespace tilelight {

// world_from_shape and pivot of a checked object: `scale`, then the rotation, both about `center`, then `translate`; or
// `matrix` as it stands. Reports a matrix that is singular or not affine, and a result that leaves the range of
// numbers.
void read_transform(Value value, const Vec3& center, Object& object, Problems& problems);

// A rotation about an axis of any length but 0, counter-clockwise seen against it; exact at quarter turns.
Mat3 rotation_about(const Vec3& axis, double angle_deg);

// Whether the linear part has determinant 0 within rounding, judged apart from the scale of its rows and columns, so
// that a stretch of 1e15 along any axis is not mistaken for a flattening.
bool is_singular(const Mat3& linear);

}  // namespace tilelight
