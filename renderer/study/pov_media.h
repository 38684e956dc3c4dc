// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "renderer/compile/bodies.h"

namespace tilelight {

// Whether POV-Ray may see something else where bodies meet of which one is transparent: in media that touch, overlap or
// lie in each other by priorities or with the Fresnel equations, and at flat faces that glass shares with anything.
// Looks at boxes of bodies, so it may say yes where they only come near.
bool do_media_meet(const Scene& scene, const std::vector<Body>& bodies);

}  // namespace tilelight
