// SPDX-License-Identifier: Apache-2.0
// The canonical form of a document and the identities taken from it.
#pragma once

#include <string>

#include "renderer/scene/document.h"

namespace tilelight {

// SHA-256 of the canonical document: a binary serialisation of the parsed values in which keys are sorted, numbers are
// the bits of their doubles, -0 is 0, and `extras`, `x-...` and `name` are left out. Spelling and order do not matter.
std::string scene_id(Value root);

// The same over what compile_scene reads: without camera, image and render.
std::string compile_key(Value root);

}  // namespace tilelight
