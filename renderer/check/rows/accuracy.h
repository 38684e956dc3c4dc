// SPDX-License-Identifier: Apache-2.0
// A: the error of pictures, and what is told of it.
#pragma once

#include "renderer/check/kit/pictures.h"

namespace tilelight::check {

Outcome told_by_pixel(const Context& context);
Outcome asked_and_reached(const Context& context);
Outcome checker_to_the_horizon(const Context& context);

}  // namespace tilelight::check
