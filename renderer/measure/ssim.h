// SPDX-License-Identifier: Apache-2.0
// SSIM: structural similarity of two pictures (Wang, Bovik, Sheikh, Simoncelli 2004, IEEE TIP 13(4)): how alike mean,
// contrast and structure are around each pixel. Pure; any thread.
#pragma once

#include "renderer/measure/image_error.h"

namespace tilelight {

// The mean over all pixels, of luma (Rec. 601) as displayed; windows of 11 pixels, Gaussian of 1.5. In [-1, 1].
// REQUIRES: images of one size.
double ssim(const DisplayedImage& a, const DisplayedImage& b);

}  // namespace tilelight
