// SPDX-License-Identifier: Apache-2.0
// A scene whose every choice is taken from bytes, so that a mutated byte is a mutated scene. Places come from a coarse
// grid as often as not: surfaces coincide, edges are aimed at, eyes stand in planes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "renderer/scene/scene.h"

namespace tilelight::fuzz {

struct SceneAndView {
  Scene scene;
  View view;
};

// No bytes left: zeros. What comes is what the language allows.
SceneAndView scene_from_bytes(const uint8_t* data, size_t size);

// For people: what the scene holds.
std::string told(const SceneAndView& made);

}  // namespace tilelight::fuzz
