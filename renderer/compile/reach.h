// SPDX-License-Identifier: Apache-2.0
// Reach: which bodies of a scene can have a part in the picture of a view. Conservative: a body that is told apart here
// meets no ray of the picture, so that what only such bodies have (mirrors, glass, ...) can be left out of the kernel.
// Normalised space, double. Pure; any thread.
#pragma once

#include <vector>

#include "renderer/compile/compiled_scene.h"

namespace tilelight {

struct ViewPlan;

struct Reach {
  // By index into CompiledScene::bodies: whether a ray from the eye or from a mirror may meet it, and whether a shadow
  // ray may. Who is seen also casts.
  std::vector<bool> is_seen, casts;

  static Reach everything(size_t bodies) { return {std::vector<bool>(bodies, true), std::vector<bool>(bodies, true)}; }
  size_t count() const;  // of the bodies with any part in the picture
};

// What primary rays may meet, and where shadow rays may pass: bodies between what is seen and a light. Once a mirror or
// glass is seen, rays may go anywhere. Looks at the boxes of bodies, so it drops nothing that is near the picture's
// border, and gives everything where looking would take longer than it may save.
// REQUIRES: plan.view (algorithm, depth, shadows) and plan.eye.
Reach find_reach(const CompiledScene& scene, const ViewPlan& plan);

// What the kernel has to do for the bodies within reach.
FeatureSet features_of(const CompiledScene& scene, const Reach& reach);

}  // namespace tilelight
