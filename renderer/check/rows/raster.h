// SPDX-License-Identifier: Apache-2.0
// The rows of group R, by file: hidden surfaces drawn from triangles.
#pragma once

#include "renderer/check/check.h"

namespace tilelight::check {

// raster_cover.cpp: samples covered once, triangles far smaller than a pixel
Outcome closed_tiling(const Context& context);
Outcome tiny_triangles(const Context& context);

// raster_methods.cpp: who is seen, by rays, by the z-buffer and by Warnock's subdivision
Outcome methods_agree(const Context& context);
Outcome through_the_eye_plane(const Context& context);

// raster_lines.cpp: what Roberts' method draws
Outcome hidden_lines(const Context& context);

// raster_point.cpp: a thousand edges in one pixel
Outcome edges_in_one_pixel(const Context& context);

// raster_perspective.cpp: what lies between the corners of a receding face
Outcome receding_face(const Context& context);

}  // namespace tilelight::check
