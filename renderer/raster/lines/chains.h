// SPDX-License-Identifier: Apache-2.0
// Lines that go on from each other, in order: dashes run through them, and a path of SVG draws them in one go. Pure.
#pragma once

#include <vector>

#include "renderer/raster/lines/line_drawing.h"

namespace tilelight::lines {

// The same lines by chains, turned so that each starts where the one before it ends, with DrawnLine::along set. A chain
// is of one body and kind, seen or hidden; it ends where more than two such lines meet.
std::vector<DrawnLine> in_chains(const std::vector<DrawnLine>& lines);

}  // namespace tilelight::lines
