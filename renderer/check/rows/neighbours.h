// SPDX-License-Identifier: Apache-2.0
// Rows of group H that stand in files of their own.
#pragma once

#include "renderer/check/check.h"

namespace tilelight::check {

// neighbours_depth.cpp: one surface before another, by every method
Outcome coplanar(const Context& context);
Outcome nearly_coplanar(const Context& context);

}  // namespace tilelight::check
