// SPDX-License-Identifier: Apache-2.0
// The light equation of local illumination (Whitted 1980, with linear attenuation):
//
//   I = Ia*ka + sum over lights l of vis_l * Il * (kd*max(0, N.L) + ks*max(0, R.V)^n) / (d + K)
//
// The only implementation; every algorithm and every shading method calls it. Pure; any thread.
#pragma once

#include "renderer/compile/compiled_scene.h"
#include "renderer/shade/surface.h"

namespace tilelight {

// max(0, R.V)^n for unit R and V, where R.V is 1 - |R-V|^2 / 2: exp(n * log1p(-|R-V|^2 / 2)) keeps the digits that
// pow(dot, n) loses for large n; a small whole n is a few products. 0 where R.V <= 0, also for n = 0.
double phong_lobe(const Vec3& mirrored, const Vec3& to_viewer, double shininess);

// The way from a place to a light. to_light is zero where the light lies at the very place.
struct LightWay {
  Vec3 to_light{0.0};     // unit
  double distance = 0.0;  // normalised units; infinite for a directional light
};
LightWay way_to_light(const CompiledLight& light, const Vec3& place);

// What a light brings to a point of a surface before it is known whether something stands between.
struct LightSample {
  Vec3 to_light{0.0};     // unit
  double distance = 0.0;  // normalised units; infinite for a directional light
  Color arriving{0.0};    // Il / (d + K)
  Color diffuse{0.0};     // arriving * kd * N.L
  Color specular{0.0};    // arriving * ks * (R.V)^n
  bool is_lit = false;    // on the light's side of the shading normal, and of the facet if that ends the light
};
// is_lit_over_curve: the light ends where the shading normal turns away from it, whatever the facet says.
LightSample sample_light(const CompiledScene& scene, const CompiledLight& light, const Surface& surface,
                         const Vec3& to_viewer, bool is_lit_over_curve);

// The sky, mixed by the height of the unit ray direction.
inline Color background_color(const Background& background, const Vec3& direction) {
  const double up = 0.5 * (1.0 + direction.y);
  return background.bottom * (1.0 - up) + background.top * up;
}

}  // namespace tilelight
