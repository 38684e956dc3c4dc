// SPDX-License-Identifier: Apache-2.0
// The knight's horse as an implicit form: limbs, muscles and cuts that flow into each other by smooth minima. Its own
// frame: `side` = |x|, `up` = y, `fore` = -z, the way it looks.
#pragma once

#include "renderer/base/vec.h"

namespace tilelight {

// Negative inside; near the surface about the distance. Mirror-symmetric in x. Object space.
double knight_form(const Vec3& p);

}  // namespace tilelight
