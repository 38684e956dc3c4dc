// SPDX-License-Identifier: Apache-2.0
// Scenes for the table of what POV-Ray can draw: at least one for each of its rows.
#pragma once

#include <string>
#include <vector>

namespace tilelight {

struct PovCase {
  std::string feature;   // the row's name
  std::string what;      // this scene
  std::string document;  // a patch (RFC 7396) of the plain scene
};

// A ball on a plane, a lamp and a camera, in 48 x 36 pixels.
extern const char* const kPlainPovScene;

std::vector<PovCase> pov_cases();

}  // namespace tilelight
