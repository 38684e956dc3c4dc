// SPDX-License-Identifier: Apache-2.0
// What the methods do for a picture, counted and shown.
#pragma once

#include "renderer/raster/lines/line_drawing.h"
#include "renderer/raster/method.h"
#include "renderer/raster/warnock.h"

namespace tilelight {

// Coverings by pixel: what is drawn over or hidden in the end is drawn in vain.
MethodWork zbuffer_work(const RasterScene& raster);

// The windows, by what became of them.
MethodWork warnock_work(const RasterScene& raster, const WarnockScene& subdivision);

MethodWork roberts_work(const LineDrawing& drawing);

}  // namespace tilelight
