// SPDX-License-Identifier: Apache-2.0
// C: fields, ups and image shapes at their ends.
#include "renderer/check/check.h"

namespace tilelight::check {

std::span<const Row> camera_rows() { return {}; }

}  // namespace tilelight::check
