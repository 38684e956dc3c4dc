// SPDX-License-Identifier: Apache-2.0
#include "renderer/shade/light_equation.h"

#include "renderer/shade/light_equation-inl.h"

namespace tilelight {

using namespace HWY_NAMESPACE;

double phong_lobe(const Vec3& mirrored, const Vec3& to_viewer, double shininess) {
  return lobe(of<double>(mirrored), of<double>(to_viewer), shininess);
}

LightWay way_to_light(const CompiledLight& light, const Vec3& place) {
  const auto way = way_to(light, of<double>(place));
  return {vec_of(way.to_light), way.distance};
}

LightSample sample_light(const CompiledScene& scene, const CompiledLight& light, const Surface& surface,
                         const Vec3& to_viewer, bool is_lit_over_curve) {
  SurfaceOf<double> at;
  at.position = of<double>(surface.position);
  at.geometric_normal = of<double>(surface.geometric_normal);
  at.normal = of<double>(surface.normal);
  at.diffuse = of<double>(surface.diffuse);
  const Material& m = surface.material->source;
  const GlossOf<double> gloss = {of<double>(m.specular), m.shininess, surface.material->is_specular};
  const auto sample = light_at<true>(scene, light, at, gloss, of<double>(to_viewer), is_lit_over_curve);
  LightSample out;
  out.to_light = vec_of(sample.way.to_light), out.distance = sample.way.distance;
  out.arriving = vec_of(sample.arriving);
  out.diffuse = vec_of(sample.diffuse), out.specular = vec_of(sample.specular);
  out.is_lit = sample.is_lit;
  return out;
}

}  // namespace tilelight
