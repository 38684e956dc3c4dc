// SPDX-License-Identifier: Apache-2.0
#include "renderer/compile/plan.h"

namespace tilelight {

std::string_view feature_name(Feature feature) {
  static constexpr std::array<std::string_view, kFeatureCount> kNames = {
      "spheres",        "boxes",        "planes",         "triangles",
      "smooth_normals", "checker",      "point_lights",   "directional_lights",
      "specular",       "shadows",      "tinted_shadows", "reflection",
      "transmission",   "nested_media", "fresnel",        "attenuation"};
  return kNames[static_cast<size_t>(feature)];
}

KernelVariant choose_variant(const FeatureSet& features) {
  const bool shadows = features.has(Feature::shadows);
  if (features.has(Feature::transmission) || features.has(Feature::tinted_shadows)) {
    return shadows ? KernelVariant::glass_shadows : KernelVariant::glass;
  }
  if (features.has(Feature::reflection)) return shadows ? KernelVariant::mirrors_shadows : KernelVariant::mirrors;
  return shadows ? KernelVariant::local_shadows : KernelVariant::local;
}

std::string_view variant_name(KernelVariant variant) {
  static constexpr std::array<std::string_view, 6> kNames = {"local",           "local+shadows", "mirrors",
                                                             "mirrors+shadows", "glass",         "glass+shadows"};
  return kNames[static_cast<size_t>(variant)];
}

}  // namespace tilelight
