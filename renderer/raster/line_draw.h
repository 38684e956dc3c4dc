// SPDX-License-Identifier: Apache-2.0
// A line drawing as samples: ink or paper. Several of them a pixel make its lines smooth, and tell their own error like
// those of any other picture.
#pragma once

#include "renderer/raster/lines/line_ink.h"
#include "renderer/trace/tile_job.h"

namespace tilelight {

void draw_ink(const LineInk& ink, const RenderSpec& spec, const TileJob& job);

}  // namespace tilelight
