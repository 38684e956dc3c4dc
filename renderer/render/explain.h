// SPDX-License-Identifier: Apache-2.0
// explain_pixel: the tree of rays behind one sample of one pixel: hits, lights, shadows, weights, colours.
#pragma once

#include <string>

#include "renderer/base/result.h"
#include "renderer/compile/compile.h"

namespace tilelight {

// As a JSON object {pixel, sample, color_linear, color_srgb8, untraced_weight, rays_truncated, rays: [{depth, kind,
// weight, origin, direction, hit: {object, body, primitive, t, position, normal, geometric_normal, side, material} or
// null, ambient or background, lights: [{light, faces_light, distance, arriving, diffuse, specular, visible}]}]},
// breadth first, and whatever the view's algorithm is; rays_truncated says that the list holds the first 1000 only.
// Errors: pixel outside the image, negative sample (code out_of_range).
Result<std::string> explain_pixel_json(const std::shared_ptr<const CompiledScene>& scene, const ViewPlan& plan,
                                       TilePool& pool, int x, int y, int sample);

}  // namespace tilelight
