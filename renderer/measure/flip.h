// SPDX-License-Identifier: Apache-2.0
// FLIP: the difference that a person sees who flips between two pictures (Andersson, Nilsson, Akenine-Moller,
// Oskarsson, Astrom, Fairchild 2020, Proc. ACM CGIT 3(2)): colour as the eye blurs it, and edges and points beside.
// Pure; any thread.
#pragma once

#include "renderer/measure/image_error.h"

namespace tilelight {

// By pixel, in [0, 1]. pixels_per_degree: of the eye's field; the paper's own is 67 (a 4K display of 0.7 m seen from
// 0.7 m). REQUIRES: images of one size.
std::vector<double> flip_map(const DisplayedImage& tested, const DisplayedImage& truth,
                             double pixels_per_degree = 67.0206);

double mean_flip(const DisplayedImage& tested, const DisplayedImage& truth);

}  // namespace tilelight
