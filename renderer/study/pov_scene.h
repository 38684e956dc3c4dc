// SPDX-License-Identifier: Apache-2.0
// A scene as POV-Ray 3.7 reads it: the same triangles, spheres, boxes and planes, camera, lights that fade as ours do,
// materials, checkers and background.
#pragma once

#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace tilelight {

struct PovScene {
  std::string text;
  std::vector<std::string> differences;  // what POV-Ray has no words for, and what stands for it
};

// view: with its camera.
PovScene pov_scene(const Scene& scene, const View& view);

}  // namespace tilelight
