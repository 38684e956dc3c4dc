// SPDX-License-Identifier: Apache-2.0
#include "renderer/measure/reference_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "renderer/base/elementary.h"

namespace tilelight::reference {
namespace {

// A light as seen from a point.
struct Incidence {
  Vec3 to_light;    // unit
  double distance;  // infinite for directional lights
  double factor;    // of attenuation
};

double attenuation_factor(const Attenuation& attenuation, double distance) {
  switch (attenuation.mode) {
    case AttenuationMode::linear:
      return 1.0 / (distance + attenuation.k);
    case AttenuationMode::inverse_square:
      return 1.0 / (distance * distance + attenuation.k);
    case AttenuationMode::none:
      return 1.0;
  }
  return 1.0;
}

Vec3 unit(const Vec3& v) {  // also of vectors whose squares leave the range of a double
  const Vec3 a = glm::abs(v);
  return glm::normalize(v / std::max({a.x, a.y, a.z}));
}

// None for a light in the very point: it has no direction.
std::optional<Incidence> incidence(const Light& light, const Vec3& point, const Attenuation& attenuation) {
  if (light.kind == LightKind::directional)
    return Incidence{-unit(light.direction), std::numeric_limits<double>::infinity(), 1.0};
  const Vec3 way = light.position - point;
  const double distance = glm::length(way);
  if (distance == 0.0) return std::nullopt;
  return Incidence{way / distance, distance, attenuation_factor(attenuation, distance)};
}

bool is_odd(double whole) { return whole - 2.0 * std::floor(0.5 * whole) == 1.0; }

// Facets that are meant to lie in one plane may do so no better than the digits of a document say.
constexpr double kLowSine = 0x1p-10;
// A curve above its facet by less than so many roundings is none.
constexpr double kLeastLift = 0x1p10;

// Whether light that goes straight to a rounded facet is hidden by nothing but a facet next to it that rises towards
// the light though its normals say that the light falls upon it too.
bool is_hidden_by_facet(const ReferenceScene& scene, const ShadingPoint& at, const Ray& ray) {
  const RoundedFacet facet = rounded_facet(scene.body(at.hit.body), at.hit);
  if (glm::dot(at.geometric, ray.direction) >= 2.0 * facet.turn) return false;
  const auto met = scene.nearest(ray);
  if (!met || met->body != at.hit.body || met->t >= 2.0 * facet.longest_edge) return false;
  if (!are_of_one_curve(scene.body(met->body), at.hit, *met)) return false;
  const ShadingPoint other = shading_point(scene.body(met->body), *met, ray.direction);
  return glm::dot(other.shading, ray.direction) > 0.0 && glm::dot(other.geometric, at.geometric) > 0.0;
}

// The light that comes over the curve: past it, and down to the facet.
Color light_over_curve(const ReferenceScene& scene, const ShadingPoint& at, const Light& light, const Vec3& lift) {
  Ray ray{at.point + lift, {}};  // from free space
  double distance = std::numeric_limits<double>::infinity();
  if (light.kind == LightKind::directional) {
    ray.direction = -unit(light.direction);
  } else {
    const Vec3 way = light.position - ray.origin;
    distance = glm::length(way);
    ray.direction = glm::normalize(way);
  }
  const Color passed = scene.transmittance(ray, distance);
  if (passed == Color(0.0)) return passed;
  return passed * scene.transmittance(scene.ray_from(at.hit, unit(lift), Coincident::before), glm::length(lift));
}

// How much of the light comes to a point of a surface. lift: from there to the curve that a rounded facet stands for.
Color visible_part(const ReferenceScene& scene, const ShadingPoint& at, const Light& light, const Incidence& in,
                   const Vec3& lift) {
  const Ray ray = scene.ray_from(at.hit, in.to_light, Coincident::before);
  const bool is_rounded = glm::length(lift) > kLeastLift * ray.noise;
  const double sine = glm::dot(at.geometric, in.to_light);
  if (is_rounded && sine < kLowSine) return light_over_curve(scene, at, light, lift);
  const Color passed = scene.transmittance(ray, in.distance);
  if (sine <= 0.0) return scene.material(at.hit.body).transmission * passed;  // the facet itself is in between
  if (!is_rounded || passed == Color(1.0) || !is_hidden_by_facet(scene, at, ray)) return passed;
  return light_over_curve(scene, at, light, lift);
}

}  // namespace

ShadingPoint shading_point(const ReferenceBody& body, const Hit& hit, const Vec3& direction) {
  const SurfacePoint surface = surface_at(body, hit);
  const bool is_inside = glm::dot(surface.geometric, direction) > 0.0;
  const Vec3 geometric = is_inside ? -surface.geometric : surface.geometric;
  const bool agrees = glm::dot(surface.shading, geometric) >= 0.0;
  return {hit, surface.point, -direction, geometric, agrees ? surface.shading : -surface.shading, is_inside};
}

double phong_lobe(const Vec3& r, const Vec3& v, double n) {
  const Vec3 apart = r - v;
  return elementary::exp(n * elementary::log1p(-0.5 * glm::dot(apart, apart)));
}

Color paint_at(const ReferenceBody& body, const Hit& hit, const Paint& paint) {
  if (const Color* color = std::get_if<Color>(&paint)) return *color;
  const Checker& checker = std::get<Checker>(paint);
  const PatternPoint pattern = pattern_at(body, hit);
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    if (axis != pattern.ignored_axis) sum += std::floor(pattern.point[axis] / checker.size);
  return is_odd(sum) ? checker.b : checker.a;
}

Color local_light(const ReferenceScene& scene, const ShadingPoint& at, const RenderSpec& render) {
  const ReferenceBody& body = scene.body(at.hit.body);
  const Material& material = scene.material(at.hit.body);
  const Color kd = paint_at(body, at.hit, material.diffuse);
  const std::optional<Vec3> lift =
      render.terminator == Terminator::smooth ? lift_to_curve(body, at.hit, at.is_inside) : std::nullopt;
  Color sum = scene.ambient() * paint_at(body, at.hit, material.ambient);
  for (const Light& light : scene.lights()) {
    const auto in = incidence(light, at.point, scene.attenuation());
    if (!in || (!lift && glm::dot(at.geometric, in->to_light) <= 0.0)) continue;  // it faces away: in its own shadow
    const double n_l = glm::dot(at.shading, in->to_light);
    if (n_l <= 0.0) continue;
    Color reflected = kd * n_l;
    const Vec3 mirrored = glm::normalize(2.0 * n_l * at.shading - in->to_light);
    if (glm::dot(mirrored, at.to_viewer) > 0.0)
      reflected += material.specular * phong_lobe(mirrored, at.to_viewer, material.shininess);
    if (glm::all(glm::equal(reflected, Color(0.0)))) continue;
    Color visible(1.0);
    if (render.shadows && light.shadow) visible = visible_part(scene, at, light, *in, lift.value_or(Vec3(0.0)));
    sum += visible * light.color * light.intensity * in->factor * reflected;
  }
  return sum;
}

Color background_at(const Background& background, const Vec3& direction) {
  return glm::mix(background.bottom, background.top, 0.5 * (1.0 + direction.y));
}

}  // namespace tilelight::reference
