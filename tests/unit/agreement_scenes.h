// SPDX-License-Identifier: Apache-2.0
// Small random scenes of everything the language knows, for holding two renderers against each other. The same seed
// gives the same scene everywhere.
#pragma once

#include <cstdint>

#include "renderer/scene/scene.h"

namespace tilelight::agreement {

struct RandomScene {
  Scene scene;
  View view;  // with a camera
};

RandomScene make_random_scene(uint64_t seed, int size_px);

}  // namespace tilelight::agreement
