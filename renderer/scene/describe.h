// SPDX-License-Identifier: Apache-2.0
// What the grammar allows, in words, for the messages of errors.
#pragma once

#include <string>

#include "renderer/scene/grammar.h"

namespace tilelight {

std::string describe_allowed(const Rule& rule);  // "3 numbers, not all 0", ...
std::string describe_range(const Range& range);  // "a number from 0 to 1", ...
std::string describe_length(const Length& length,
                            const std::string& noun);  // "at least 3 numbers, a multiple of 3", ...

}  // namespace tilelight
