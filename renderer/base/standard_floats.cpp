// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/standard_floats.h"

namespace tilelight {

// Not inline, so that no arithmetic of the caller is moved across.
StandardFloats::StandardFloats() {
  std::fegetenv(&host_);
  std::fesetenv(FE_DFL_ENV);  // clears flush-to-zero and denormals-are-zero as well
}

StandardFloats::~StandardFloats() { std::fesetenv(&host_); }

}  // namespace tilelight
