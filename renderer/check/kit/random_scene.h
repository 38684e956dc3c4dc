// SPDX-License-Identifier: Apache-2.0
// Ordinary scenes that nobody has tuned anything on: balls, boxes and chessmen of mixed materials on a floor.
#pragma once

#include <string>

#include "renderer/check/kit/rays.h"

namespace tilelight::check {

// A document without "image" and "render", to which the text of these is added in front. The same on every machine.
std::string random_scene_json(Random& random, const std::string& image_and_render);

}  // namespace tilelight::check
