// SPDX-License-Identifier: Apache-2.0
#include "renderer/check/rows/raster.h"

namespace tilelight::check {
namespace {

constexpr Row kRows[] = {
    {"R1", "closed tiling", "1e5 triangles, corners on pixel centres and on the grid of samples",
     "edges that belong to both triangles, or to neither", closed_tiling},
    {"R2", "one scene by three methods", "corners on 1/256 pixel, triangles of a few pixels",
     "corners on whole pixels, on 1/16 pixel", methods_agree},
    {"R3", "triangles through the eye's plane", "w from -1e3 to 1e3", "corners divided by their w, behind the eye too",
     through_the_eye_plane},
    {"R4", "triangles far below a pixel", "1e6 of 0.1 pixels", "spans that hold the pixels of both ends",
     tiny_triangles},
    {"R5", "edges that meet in one pixel", "1000 of them", "subdivision until one face is left", edges_in_one_pixel},
    {"R6", "hidden lines", "two cubes through each other, three bars in a circle, chessmen",
     "no junctions; bars painted one after the other", hidden_lines},
    {"R7", "light on a receding face", "depths of 1 to 100", "interpolation over the screen", receding_face},
};

}  // namespace

std::span<const Row> raster_rows() { return kRows; }

}  // namespace tilelight::check
