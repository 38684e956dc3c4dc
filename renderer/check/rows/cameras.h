// SPDX-License-Identifier: Apache-2.0
// A wall of strips, turned so that no axis of the camera is one of the world: which strip a pixel shows follows from
// the camera's geometry alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/check/check.h"
#include "renderer/check/kit/pictures.h"

namespace tilelight::check {

// Boxes with their faces in z = 0, strip i over x in [i - count / 2, i - count / 2 + 1] * width; body ids are places.
// Before the turn.
struct Strips {
  int count = 2;
  double width = 1.0, half_height = 1.0;  // scene units
};

// The camera is given in the strips' own frame and turned with them. Square.
ParsedScene view_of_strips(const Strips& strips, const Camera& camera, int size_px);

// The strip that each pixel shows to a camera on the z axis that sees view_height of the wall.
std::vector<uint64_t> expected_strips(const Strips& strips, double view_height, int size_px);

// Of first surfaces, whose upper half is the body. Percent.
double differing_bodies(const std::vector<uint64_t>& expected_bodies, const std::vector<uint64_t>& ids);
// How often the body falls from one pixel of a row to the next.
int64_t steps_back(const std::vector<uint64_t>& ids, int width);

// The rows of cameras_far.cpp.
std::span<const Row> far_camera_rows();

}  // namespace tilelight::check
