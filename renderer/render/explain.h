// SPDX-License-Identifier: Apache-2.0
// explain_pixel: the tree of rays behind one sample of one pixel: hits, lights, shadows, weights, colours.
#pragma once

#include <string>

#include "renderer/base/result.h"
#include "renderer/compile/compile.h"

namespace tilelight {

// As a JSON object {pixel, sample, color_linear, color_srgb8, rays: [{depth, kind, weight, origin, direction, hit:
// {object, body, t, position, normal, material}, lights: [{light, visible, diffuse, specular, attenuation}], color}]}.
// Errors: pixel outside the image (code out_of_range).
Result<std::string> explain_pixel_json(const CompiledScene& scene, const ViewPlan& plan, int x, int y, int sample);

}  // namespace tilelight
