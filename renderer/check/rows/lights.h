// SPDX-License-Identifier: Apache-2.0
// What the rows of the L group share: dark scenes under chosen lights, and views of which every sample's place is
// known.
#pragma once

#include <cmath>
#include <string>

#include "renderer/check/check.h"
#include "renderer/check/kit/paths.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/film/sampling.h"

namespace tilelight::check {

// Members of a document: no light but these.
inline std::string dark_but(const std::string& lights) {
  return R"("ambient": 0, "background": {"bottom": 0, "top": 0}, "lights": [)" + lights + "], ";
}

// A square orthographic view along -z from z = 5, x to the right and y up; `height` from edge to edge.
inline std::string view_along_z(int size, double height, int samples) {
  return R"("camera": {"type": "orthographic", "position": [0, 0, 5], "target": [0, 0, 0], "height": )" + text(height) +
         R"(}, "image": {"width": )" + text(size) + R"(, "height": )" + text(size) + R"(}, "render": {"samples": )" +
         text(samples) + "}, ";
}

// visit(pixel, across, down): where sample 0 of each pixel lies on the plane of such a view, from its middle.
template <class Visit>
void for_each_pixel(int size, double height, Visit visit) {
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const SamplePoint p = sample_point(x, y, 0, 0);
      const double px = height / size;
      visit(static_cast<size_t>(y) * static_cast<size_t>(size) + static_cast<size_t>(x), (x + p.x - 0.5 * size) * px,
            (y + p.y - 0.5 * size) * px);
    }
  }
}

inline double relative(double value, double expected) { return std::abs(value - expected) / std::abs(expected); }

// lights_lobe.cpp
Outcome lobe_range(const Context& context);
Outcome lobe_guards(const Context& context);
Outcome needle_lobe(const Context& context);
// lights_range.cpp
Outcome many_decades(const Context& context);
Outcome inverse_square(const Context& context);

}  // namespace tilelight::check
