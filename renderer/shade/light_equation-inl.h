// SPDX-License-Identifier: Apache-2.0
// The light equation of light_equation.h for a number R: one double, or several hits side by side. The only
// implementation. Included once for every instruction set.
#if defined(TILELIGHT_LIGHT_EQUATION_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TILELIGHT_LIGHT_EQUATION_INL_H
#undef TILELIGHT_LIGHT_EQUATION_INL_H
#else
#define TILELIGHT_LIGHT_EQUATION_INL_H
#endif

#include <limits>

#include "renderer/base/elementary.h"
#include "renderer/compile/compiled_scene.h"
#include "renderer/shade/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {

// x^n by squares of x, for a whole n of 0 to kMostProducts: off by n roundings.
inline constexpr double kMostProducts = 128.0;
template <class R>
HWY_INLINE R power_by_products(R x, R n) {
  R out(1.0);
  for (R square = x; any(n > R(0.0)); square = square * square) {
    const R half = floored(R(0.5) * n);
    out = select(n - (half + half) == R(1.0), out * square, out);
    n = half;
  }
  return out;
}

template <class R>
HWY_INLINE R lobe(const Of3<R>& mirrored, const Of3<R>& to_viewer, R shininess) {
  const Of3<R> apart = mirrored - to_viewer;
  const R fall = R(-0.5) * dot(apart, apart);
  constexpr double kInvisible = -60.0;  // e^-60 of any displayable light is nothing
  const auto is_seen = (dot(mirrored, to_viewer) > R(0.0)) & !(shininess * fall < R(kInvisible));  // log1p(x) <= x
  const auto is_product = (shininess <= R(kMostProducts)) & (shininess == floored(shininess));
  R out(0.0);
  if (any(is_seen & is_product))
    out = select(is_seen & is_product, power_by_products(R(1.0) + fall, select(is_product, shininess, R(0.0))), out);
  if (any(is_seen & !is_product)) {
    const auto by_logarithm = [](double by, double n) {
      const double exponent = n * elementary::log1p(by);
      return exponent < kInvisible ? 0.0 : elementary::exp(exponent);
    };
    each_lane(is_seen & !is_product, out, by_logarithm, fall, shininess);
  }
  return out;
}

HWY_INLINE bool is_directional(const CompiledLight& light) {
  if (!is_built_in(Feature::point_lights)) return true;
  return is_built_in(Feature::directional_lights) && light.kind == LightKind::directional;
}

template <class R>
struct LightWayOf {
  Of3<R> to_light;  // unit; zero where the light lies at the very place
  R distance;       // normalised units; infinite for a directional light
};
template <class R>
HWY_INLINE LightWayOf<R> way_to(const CompiledLight& light, const Of3<R>& place) {
  if (is_directional(light)) return {of<R>(light.to_light), R(std::numeric_limits<double>::infinity())};
  const Of3<R> path = of<R>(light.position) - place;
  const R distance = length(path);
  return {(R(1.0) / select(distance > R(0.0), distance, R(1.0))) * path, distance};
}

// distance: normalised; K is in the user's units.
template <class R>
HWY_INLINE R attenuation_factor(const CompiledScene& scene, R distance) {
  if (!is_built_in(Feature::attenuation)) return R(1.0);
  const R d = distance * R(scene.units);
  switch (scene.attenuation.mode) {
    case AttenuationMode::linear:
      return R(1.0) / (d + R(scene.attenuation.k));
    case AttenuationMode::inverse_square:
      return R(1.0) / (d * d + R(scene.attenuation.k));
    case AttenuationMode::none:
      return R(1.0);
  }
  return R(1.0);
}

template <class R>
struct LightSampleOf {
  LightWayOf<R> way;
  MaskOf<R> is_lit;
  Of3<R> arriving, diffuse, specular;  // 0 where not lit
};
// Whether light that falls upon a rounded surface comes over the curve (terminator.h): from behind the facet, or so low
// that neighbours may hide it which a document's digits put in one plane with it no better than this.
template <class R>
HWY_INLINE MaskOf<R> comes_over_curve(const Of3<R>& geometric_normal, const Of3<R>& to_light) {
  constexpr double kLow = 0x1p-10;
  return dot(geometric_normal, to_light) < R(kLow);
}

// kGlossy: something in the scene has a specular part.
template <bool kGlossy, class R>
HWY_INLINE LightSampleOf<R> light_at(const CompiledScene& scene, const CompiledLight& light,
                                     const SurfaceOf<R>& surface, const GlossOf<R>& gloss, const Of3<R>& to_viewer,
                                     MaskOf<R> is_lit_over_curve) {
  LightSampleOf<R> out;
  out.way = way_to(light, surface.position);
  const Of3<R>& to_light = out.way.to_light;
  const R cosine = dot(surface.normal, to_light);
  const auto is_before = is_lit_over_curve | (dot(surface.geometric_normal, to_light) > R(0.0));
  out.is_lit = (out.way.distance > R(0.0)) & (cosine > R(0.0)) & is_before;
  const Of3<R> none = of<R>(Vec3(0.0));
  out.arriving = out.diffuse = out.specular = none;
  if (!any(out.is_lit)) return out;
  const R factor = is_directional(light) ? R(1.0) : attenuation_factor(scene, out.way.distance);
  const Of3<R> arriving = factor * of<R>(light.intensity);
  out.arriving = select(out.is_lit, arriving, none);
  out.diffuse = select(out.is_lit, cosine * (arriving * surface.diffuse), none);
  if (!kGlossy) return out;
  const auto is_glossy = out.is_lit & gloss.is_specular;
  if (!any(is_glossy)) return out;
  const Of3<R> mirrored = (R(2.0) * cosine) * surface.normal - to_light;
  const R shine = lobe(mirrored, to_viewer, gloss.shininess);
  out.specular = select(is_glossy, shine * (arriving * gloss.specular), none);
  return out;
}

}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#endif
