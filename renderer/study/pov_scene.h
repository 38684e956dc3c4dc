// SPDX-License-Identifier: Apache-2.0
// A scene as POV-Ray 3.7 reads it: the same triangles, spheres, boxes and planes, camera, lights that fade as ours do,
// materials, checkers and background. pov_features.h has what it can say of the scene language.
#pragma once

#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace tilelight {

struct PovScene {
  std::string text;
  std::vector<std::string> differences;  // what it draws otherwise, as sentences; see pov_notes
};

// view: with its camera. All light is multiplied by 2^exposure, for POV-Ray's pictures end at 1.
PovScene pov_scene(const Scene& scene, const View& view);

}  // namespace tilelight
