// SPDX-License-Identifier: Apache-2.0
// Which features the kernels of this build know: all of them. tests/bench/plan_proof builds them again without one, to
// prove that a feature costs a scene nothing that does not use it.
#pragma once

#include "renderer/compile/plan.h"

namespace tilelight {

constexpr bool is_built_in([[maybe_unused]] Feature feature) {
#ifdef TILELIGHT_WITHOUT
  return feature != Feature::TILELIGHT_WITHOUT;
#else
  return true;
#endif
}

}  // namespace tilelight
