// SPDX-License-Identifier: Apache-2.0
// The runs of group B that have a file of their own.
#pragma once

#include "renderer/check/check.h"

namespace tilelight::check {

// boxes_seams.cpp: where boxes touch, and sizes that differ by many powers of ten.
Outcome corner(const Context& context);
Outcome seams_of_boxes(const Context& context);
Outcome tiny_box(const Context& context);
Outcome sheet_on_floor(const Context& context);
Outcome huge_room(const Context& context);

}  // namespace tilelight::check
