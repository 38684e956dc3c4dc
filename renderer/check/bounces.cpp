// SPDX-License-Identifier: Apache-2.0
// M: mirrors and media in long rows.
#include "renderer/check/check.h"

namespace tilelight::check {

std::span<const Row> bounce_rows() { return {}; }

}  // namespace tilelight::check
