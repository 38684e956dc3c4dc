// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "renderer/trace/variants.h"

namespace tilelight {

Kernel kernel_of(KernelVariant variant) {
  static constexpr std::array<Kernel, 6> kKernels = {run_local,           run_local_shadows, run_mirrors,
                                                     run_mirrors_shadows, run_glass,         run_glass_shadows};
  return kKernels[static_cast<size_t>(variant)];
}

}  // namespace tilelight
