// SPDX-License-Identifier: Apache-2.0
// Where a pass's samples do most: the cells that give the largest fall of the picture's error for a sample.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/film/film.h"

namespace tilelight {

// By cell, how many samples its pixels shall have: a chosen cell gets twice or four times what it has, so that its
// blocks stay aligned. variances: by cell, as ErrorMap tells them. Spends at most `samples` a pixel in the mean, but
// gives to one cell at least, unless all have a million. Of cells that are worth the same, the first in the image.
// Pure.
std::vector<uint32_t> spend(const Film& film, const std::vector<float>& variances, double samples);

}  // namespace tilelight
