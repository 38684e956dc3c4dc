// SPDX-License-Identifier: Apache-2.0
#include "renderer/shade/light_equation.h"

#include <cmath>
#include <limits>

#include "renderer/base/elementary.h"

namespace tilelight {
namespace {

// distance: normalised; K is in the user's units.
double attenuation_factor(const CompiledScene& scene, double distance) {
  const double d = distance * scene.units;
  switch (scene.attenuation.mode) {
    case AttenuationMode::linear:
      return 1.0 / (d + scene.attenuation.k);
    case AttenuationMode::inverse_square:
      return 1.0 / (d * d + scene.attenuation.k);
    case AttenuationMode::none:
      return 1.0;
  }
  return 1.0;
}

// x^n by squares of x, for a whole n of 0 to kMostProducts: off by n roundings.
constexpr double kMostProducts = 128.0;
double power_by_products(double x, int n) {
  double out = 1.0;
  for (double square = x; n > 0; n /= 2, square *= square) {
    if (n % 2 == 1) out *= square;
  }
  return out;
}

}  // namespace

double phong_lobe(const Vec3& mirrored, const Vec3& to_viewer, double shininess) {
  if (!(glm::dot(mirrored, to_viewer) > 0.0)) return 0.0;
  const Vec3 apart = mirrored - to_viewer;
  const double fall = -0.5 * glm::dot(apart, apart);
  constexpr double kInvisible = -60.0;            // e^-60 of any displayable light is nothing
  if (shininess * fall < kInvisible) return 0.0;  // log1p(x) <= x
  if (shininess <= kMostProducts && shininess == std::floor(shininess))
    return power_by_products(1.0 + fall, static_cast<int>(shininess));
  const double exponent = shininess * elementary::log1p(fall);
  return exponent < kInvisible ? 0.0 : elementary::exp(exponent);
}

LightWay way_to_light(const CompiledLight& light, const Vec3& place) {
  if (light.kind == LightKind::directional) return {light.to_light, std::numeric_limits<double>::infinity()};
  const Vec3 path = light.position - place;
  const double distance = glm::length(path);
  return distance > 0.0 ? LightWay{path / distance, distance} : LightWay{Vec3(0.0), distance};
}

LightSample sample_light(const CompiledScene& scene, const CompiledLight& light, const Surface& surface,
                         const Vec3& to_viewer, bool is_rounded) {
  LightSample out;
  const LightWay way = way_to_light(light, surface.position);
  out.to_light = way.to_light, out.distance = way.distance;
  if (!(way.distance > 0.0)) return out;  // no direction, no light
  const double factor = light.kind == LightKind::directional ? 1.0 : attenuation_factor(scene, way.distance);
  const double cosine = glm::dot(surface.normal, out.to_light);
  if (!(cosine > 0.0) || !(is_rounded || glm::dot(surface.geometric_normal, out.to_light) > 0.0)) return out;
  out.is_lit = true;
  out.arriving = light.intensity * factor;
  out.diffuse = out.arriving * surface.diffuse * cosine;
  if (surface.material->is_specular) {
    const Vec3 mirrored = 2.0 * cosine * surface.normal - out.to_light;
    const Material& m = surface.material->source;
    out.specular = out.arriving * m.specular * phong_lobe(mirrored, to_viewer, m.shininess);
  }
  return out;
}

}  // namespace tilelight
