// SPDX-License-Identifier: Apache-2.0
// What is up in a camera's picture. A camera's `up` need not be at right angles to the view, but along the view it says
// nothing; then one rule holds for every method, for what is exported and for the page: the world's up, +y, takes its
// place, and in a view straight up or down, where that says nothing either, the picture stands as if the camera had
// been tilted there from looking along -z: +x is on the right, so that -z (north) is up looking down and +z looking up.
// Pure; any thread.
#pragma once

#include "renderer/scene/scene.h"

namespace tilelight {

// Up counts as along the view where the sine of the angle between them is smaller.
inline constexpr double kUpAlongViewSine = 1e-10;

// REQUIRES of both: camera.position != camera.target.
bool is_up_along_view(const Camera& camera);
// `up`, or what takes its place; unit.
Vec3 usable_up(const Camera& camera);

}  // namespace tilelight
