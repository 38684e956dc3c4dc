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

// How much of the light comes to a point that lies `lift` above the surface.
Color visible_part(const ReferenceScene& scene, const ShadingPoint& at, const Light& light, const Incidence& in,
                   const Vec3& lift) {
  Ray ray = scene.ray_from(at.hit, in.to_light, Coincident::before);
  if (lift == Vec3(0.0)) return scene.transmittance(ray, in.distance);
  ray.origin += lift;
  if (light.kind == LightKind::directional) return scene.transmittance(ray, in.distance);
  const Vec3 way = light.position - ray.origin;
  ray.direction = glm::normalize(way);
  return scene.transmittance(ray, glm::length(way));
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
