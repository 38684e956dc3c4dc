// SPDX-License-Identifier: Apache-2.0
#include "renderer/shade/scatter.h"

#include <algorithm>
#include <cmath>

#include "renderer/shade/surface-inl.h"

namespace tilelight {
namespace {

struct Refraction {
  bool is_total = false;
  Vec3 direction{0.0};
  double fresnel = 1.0;  // reflected share, unpolarised
};

// Fresnel's equations, between cosines that Snell's law joins; eta = ior before / ior after.
double reflectance(double cos_in, double cos_out, double eta) {
  const double s = (eta * cos_in - cos_out) / (eta * cos_in + cos_out);
  const double p = (cos_in - eta * cos_out) / (cos_in + eta * cos_out);
  return 0.5 * (s * s + p * p);
}

// Snell's law at a normal towards the incoming side.
Refraction refract(const Vec3& d, const Vec3& n, double eta) {
  const double cos_in = -glm::dot(d, n);
  const double sin2_out = eta * eta * (1.0 - cos_in) * (1.0 + cos_in);
  if (!(sin2_out < 1.0)) return {true, {}, 1.0};
  const double cos_out = std::sqrt(1.0 - sin2_out);
  return {false, glm::normalize(eta * d + (eta * cos_in - cos_out) * n), reflectance(cos_in, cos_out, eta)};
}

double other_side(double sine_or_cosine) { return std::sqrt((1.0 - sine_or_cosine) * (1.0 + sine_or_cosine)); }

// Whether a ray is bent into total reflection at a facet that stands for a curved surface.
struct CurvedEdge {
  double cos_delta, sin_delta;  // between the facet's normal and its corners'
  explicit CurvedEdge(const Surface& surface) : cos_delta(facet_cosine(surface)), sin_delta(other_side(cos_delta)) {}
  bool is_total(double cos_in, double eta) const {
    const double sin_critical = 1.0 / eta;
    return cos_in < other_side(sin_critical) * cos_delta - sin_critical * sin_delta;
  }
};

// Snell's law at a facet that stands for a curved surface, by the normal that is interpolated there. The facet lies
// under that surface, where a ray that has come in grazing meets the normal at more than the critical angle, and would
// go round for ever: in a ball of radius R its sine is as R / r of what it was, r the distance from the middle, and r /
// R no less than cos(delta), delta the angle between the facet's normal and its corners'. So
// - a normal that is turned from the ray is met grazing: the sine inside is 1 / n and no more;
// - reflection is total only beyond the critical angle plus delta; nearer to it the ray leaves, at delta above the
//   surface. In a ball that suffices: sin(critical + delta) >= sin(critical) / cos(delta) while critical + delta is no
//   right angle, beyond which nothing is total. It also allows for corners' normals off by as much as delta;
// - what would lead back under the facet is mirrored at its plane (where Cycles turns the normal until the mirror
//   direction is above it, ensure_valid_specular_reflection).
// All light goes on, is all reflected, or is shared by Fresnel's equations: none is lost.
Refraction refract_curved(const Surface& surface, const Vec3& d, double eta) {
  const Vec3& n = surface.normal;
  const double cos_in = -glm::dot(d, n);
  const auto bent_to = [&](double sin_out, double cos_out) {
    const Vec3 along = unit_of(d + cos_in * n);
    return Refraction{false, sin_out * along - cos_out * n, reflectance(other_side(sin_out / eta), cos_out, eta)};
  };
  Refraction out{true, {}, 1.0};
  if (cos_in > 0.0) {
    out = refract(d, n, eta);
  } else if (eta < 1.0) {
    out = bent_to(eta, other_side(eta));
  }
  if (out.is_total) {
    const CurvedEdge edge(surface);
    if (edge.is_total(std::max(cos_in, 0.0), eta)) return out;
    out = bent_to(edge.cos_delta, edge.sin_delta);
  }
  const double above = glm::dot(out.direction, surface.geometric_normal);
  if (above > 0.0) out.direction -= 2.0 * above * surface.geometric_normal;
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

Scatter scatter_transparent(const Surface& surface, const Vec3& incoming, double ior_before, double ior_after,
                            bool is_smooth) {
  const Material& m = surface.material->source;
  const double eta = ior_before / ior_after;
  if (eta == 1.0) {  // exactly straight on
    Scatter out = scatter_thin(surface, incoming);
    if (m.fresnel) out.mirror_weight = Color(0.0);
    return out;
  }
  Scatter out = mirror_alone(surface, incoming);
  const Refraction bent =
      is_smooth ? refract_curved(surface, incoming, eta) : refract(incoming, surface.geometric_normal, eta);
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
