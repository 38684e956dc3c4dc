// SPDX-License-Identifier: Apache-2.0
// M: one interface at the ends of its formulas, by the scattering functions themselves.
#include <algorithm>
#include <cmath>

#include "renderer/base/elementary.h"
#include "renderer/check/rows/bounces.h"
#include "renderer/shade/scatter.h"

namespace tilelight::check {
namespace {

// A level interface met from above.
class Interface {
 public:
  Interface() {
    material_.source.transmission = Color(1.0);
    material_.source.reflection = Color(1.0);
    material_.source.fresnel = true;
    surface_.normal = surface_.geometric_normal = Vec3(0.0, 0.0, 1.0);
    surface_.material = &material_;
  }
  Scatter scatter(const Vec3& incoming, double ior_before, double ior_after) const {
    return scatter_transparent(surface_, incoming, ior_before, ior_after, false);
  }

 private:
  CompiledMaterial material_;
  Surface surface_;
};

bool is_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

// From glass into the air: on which side of arcsin(1 / 1.5) = 0.7297276562 light goes through.
Outcome total_reflection(const Context&) {
  const double critical = elementary::atan2(1.0, std::sqrt(1.25));
  const Interface glass;
  double wrong = 0.0;
  int64_t bad = 0, naive_bad = 0;
  for (int step = -10000; step <= 10000; ++step) {
    const double off = 1e-10 * step, theta = critical + off;
    const Vec3 incoming(elementary::sin(theta), 0.0, -elementary::cos(theta));
    const Scatter out = glass.scatter(incoming, 1.5, 1.0);
    const bool goes_through = out.refract_weight.r > 0.0;
    if (goes_through != (off < 0.0)) note(wrong, std::abs(off));
    bad += !is_finite(out.mirrored) || !is_finite(out.refracted) || !std::isfinite(out.mirror_weight.r);
    const auto cosine = static_cast<float>(-incoming.z);
    naive_bad += !std::isfinite(std::sqrt(1.0f - 1.5f * 1.5f * (1.0f - cosine * cosine)));
  }
  // Where it turns from one to the other, by halving.
  double below = 0.7, above = 0.75;
  for (int i = 0; i < 50; ++i) {
    const double theta = 0.5 * (below + above);
    const Vec3 incoming(elementary::sin(theta), 0.0, -elementary::cos(theta));
    (glass.scatter(incoming, 1.5, 1.0).refract_weight.r > 0.0 ? below : above) = theta;
  }
  return {{at_most(1e-7, "farthest from the critical angle on the wrong side, rad", wrong),
           within(1e-10, "angle of the turn against 0.7297276562, rad off", below, 0.7297276562),
           at_most(0, "directions and weights not finite", static_cast<double>(bad))},
          {at_most(0, "directions and weights not finite", static_cast<double>(naive_bad))}};
}

// 1 - F = 2 c q (1 / (c + q)^2 + n^2 / (n^2 c + q)^2) with c the cosine and q^2 = n^2 - 1 + c^2, without a difference.
Outcome grazing_fresnel(const Context&) {
  constexpr double kIor = 1.5, kIor2 = kIor * kIor;
  const Interface glass;
  double worst = 0.0, naive_worst = 0.0;
  for (int exponent = 1; exponent <= 12; ++exponent) {
    const double c = elementary::exp(-exponent * elementary::log(10.0));
    const double q = std::sqrt(kIor2 - 1.0 + c * c), s = c + q, p = kIor2 * c + q;
    const double expected = 1.0 - 2.0 * c * q * (1.0 / (s * s) + kIor2 / (p * p));
    const Scatter out = glass.scatter({std::sqrt((1.0 - c) * (1.0 + c)), 0.0, -c}, 1.0, kIor);
    note(worst, std::abs(out.mirror_weight.r - expected));
    const double opposite = 1.0 - c, at_zero = (kIor - 1.0) * (kIor - 1.0) / ((kIor + 1.0) * (kIor + 1.0));
    const double schlick = at_zero + (1.0 - at_zero) * opposite * opposite * opposite * opposite * opposite;
    note(naive_worst, std::abs(schlick - expected));
  }
  return {{at_most(1e-12, "reflected share, off by", worst)}, {at_most(1e-12, "reflected share, off by", naive_worst)}};
}

}  // namespace tilelight::check
