// SPDX-License-Identifier: Apache-2.0
#include "renderer/shade/scatter.h"

#include <cmath>

#include "renderer/shade/surface-inl.h"

namespace tilelight {
namespace {

struct Refraction {
  bool is_total = false;
  Vec3 direction{0.0};
  double fresnel = 1.0;  // reflected share, unpolarised
};

// Snell's law at a normal towards the incoming side; eta = ior before / ior after.
Refraction refract(const Vec3& d, const Vec3& n, double eta) {
  const double cos_in = -glm::dot(d, n);
  const double sin2_out = eta * eta * (1.0 - cos_in) * (1.0 + cos_in);
  if (!(sin2_out < 1.0)) return {true, {}, 1.0};
  const double cos_out = std::sqrt(1.0 - sin2_out);
  Refraction out;
  out.direction = glm::normalize(eta * d + (eta * cos_in - cos_out) * n);
  const double s = (eta * cos_in - cos_out) / (eta * cos_in + cos_out);
  const double p = (cos_in - eta * cos_out) / (cos_in + eta * cos_out);
  out.fresnel = 0.5 * (s * s + p * p);
  return out;
}

}  // namespace

Vec3 mirror_direction(const Surface& surface, const Vec3& incoming) {
  using namespace HWY_NAMESPACE;
  return vec_of(
      mirror_direction_at(of<double>(surface.normal), of<double>(surface.geometric_normal), of<double>(incoming)));
}

namespace {

Scatter mirror_alone(const Surface& surface, const Vec3& incoming) {
  Scatter out;
  out.mirrored = mirror_direction(surface, incoming);
  out.mirror_weight = surface.material->source.reflection;
  return out;
}

}  // namespace

Scatter scatter_thin(const Surface& surface, const Vec3& incoming) {
  Scatter out = mirror_alone(surface, incoming);
  out.refracted = incoming;
  out.refract_weight = surface.material->source.transmission;
  return out;
}

Scatter scatter_transparent(const Surface& surface, const Vec3& incoming, double ior_before, double ior_after) {
  const Material& m = surface.material->source;
  const double eta = ior_before / ior_after;
  if (eta == 1.0) {  // exactly straight on
    Scatter out = scatter_thin(surface, incoming);
    if (m.fresnel) out.mirror_weight = Color(0.0);
    return out;
  }
  Scatter out = mirror_alone(surface, incoming);
  // A shading normal turned from the viewer has no incoming side: fall back to the geometric one.
  Vec3 n = glm::dot(incoming, surface.normal) < 0.0 ? surface.normal : surface.geometric_normal;
  Refraction bent = refract(incoming, n, eta);
  if (!bent.is_total && glm::dot(bent.direction, surface.geometric_normal) >= 0.0) {
    bent = refract(incoming, surface.geometric_normal, eta);
  }
  if (m.fresnel) {
    out.mirror_weight = m.reflection * bent.fresnel;
  } else if (bent.is_total) {
    out.mirror_weight += m.transmission;
  }
  if (bent.is_total) return out;
  out.refracted = bent.direction;
  out.refract_weight = m.fresnel ? m.transmission * (1.0 - bent.fresnel) : m.transmission;
  return out;
}

}  // namespace tilelight
