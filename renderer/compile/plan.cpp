// SPDX-License-Identifier: Apache-2.0
#include "renderer/compile/plan.h"

namespace tilelight {

std::string_view feature_name(Feature feature) {
  static constexpr std::array<std::string_view, kFeatureCount> kNames = {
      "spheres",        "boxes",      "planes",       "triangles",    "smooth_normals", "checker",
      "point_lights",   "directional_lights", "specular", "shadows",  "tinted_shadows", "reflection",
      "transmission",   "nested_media", "fresnel",    "attenuation"};
  return kNames[static_cast<size_t>(feature)];
}

}  // namespace tilelight
