// SPDX-License-Identifier: Apache-2.0
// Hints for words that are almost right: keys and names of a scene, parameters of a query. Pure.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tilelight {

// "did you mean "radius"?", or nothing if no candidate is near (Damerau and Levenshtein's distance, restricted).
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

}  // namespace tilelight
