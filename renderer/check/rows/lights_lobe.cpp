// SPDX-License-Identifier: Apache-2.0
// L: the specular lobe. Under a light from the viewer's own direction a ball shows cos(2 theta)^n = (1 - 2 s^2)^n at
// the distance s from the middle of its disc, the mean of which is 1 / (2 (n + 1)).
#include <algorithm>

#include "renderer/base/elementary.h"
#include "renderer/check/kit/naive.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/rows/lights.h"
#include "renderer/shade/light_equation.h"

namespace tilelight::check {
namespace {

using elementary::kPi;

// `window`: the part of the disc that is seen, from edge to edge.
Picture headlight(const Context& context, double shininess, int size, double window, int samples) {
  return picture_of(scene_of("{" + view_along_z(size, window, samples) +
                             dark_but(R"({"type": "directional", "direction": [0, 0, -1]})") +
                             R"("objects": [{"type": "sphere", "material": {"ambient": 0, "diffuse": 0, "specular": 1,
                               "shininess": )" +
                             text(shininess) + "}}]}"),
                    context.pool);
}

double lobe_at(double s2, double shininess) {
  return s2 < 0.5 ? elementary::exp(shininess * elementary::log1p(-2.0 * s2)) : 0.0;
}

// Where e^-32 and less is left of the lobe, nothing needs to be looked at.
double window_of(double shininess) { return 2.0 * std::min(1.0, 4.0 / std::sqrt(std::max(shininess, 1.0))); }

// N.L, R and R.V in Real, pow(dot, n).
template <class Real>
double pow_of_dot(double x, double y, double shininess) {
  using V = glm::vec<3, Real>;
  const V n = glm::normalize(V(x, y, std::sqrt(1.0 - x * x - y * y))), to_light(0, 0, 1);
  const V mirrored = Real(2) * glm::dot(n, to_light) * n - to_light;
  const Real cosine = std::min(Real(1), glm::dot(mirrored, to_light));
  return cosine > Real(0) ? elementary::pow(cosine, shininess) : 0.0;
}

struct Apart {
  double ours = 0.0, in_float = 0.0, in_double = 0.0;
};
Apart apart_at_points(const Context& context, double shininess, int size) {
  const double window = window_of(shininess);
  const Picture picture = headlight(context, shininess, size, window, 1);
  Apart worst;
  for_each_pixel(size, window, [&](size_t pixel, double x, double y) {
    if (x * x + y * y >= 1.0) return;
    const double expected = lobe_at(x * x + y * y, shininess);
    note(worst.ours, std::abs(picture.linear[3 * pixel] - expected));
    note(worst.in_float, std::abs(pow_of_dot<float>(x, y, shininess) - expected));
    note(worst.in_double, std::abs(pow_of_dot<double>(x, y, shininess) - expected));
  });
  return worst;
}

// pow(R.V, n) in float, and nothing before it.
float naive_lobe(const Vec3& mirrored, const Vec3& to_viewer, double n) {
  const float cosine = glm::dot(Vec3f(mirrored), Vec3f(to_viewer));
  return static_cast<float>(elementary::pow(cosine, static_cast<float>(n)));
}

}  // namespace

Outcome lobe_range(const Context& context) {
  const int size = context.is_quick ? 64 : 128;
  double worst_mean = 0.0, worst = 0.0, naive_worst = 0.0;
  for (const double n : {0.0, 1.0, 1e2, 1e4, 1e6}) {
    const double window = window_of(n);
    const Picture picture = headlight(context, n, size, window, 32);
    double sum = 0.0;
    for (size_t i = 0; i < picture.linear.size(); i += 3) sum += picture.linear[i];
    const double mean = sum / (static_cast<double>(size) * size) * window * window / kPi;
    note(worst_mean, relative(mean, 0.5 / (n + 1.0)));
    const Apart apart = apart_at_points(context, n, size);
    note(worst, apart.ours);
    note(naive_worst, apart.in_float);
  }
  return {{at_most(1e-3, "mean over the disc against 1 / (2 (n + 1)), relative", worst_mean),
           at_most(1e-4, "(1 - 2 s^2)^n, off by", worst)},
          {at_most(1e-4, "(1 - 2 s^2)^n, off by", naive_worst)}};
}

Outcome lobe_guards(const Context&) {
  const Vec3 viewer(0.0, 0.0, 1.0);
  const Vec3 down = glm::normalize(Vec3(1.0, 0.0, -0.1)), side(1.0, 0.0, 0.0), longer = (1.0 + 1e-7) * viewer;
  const double behind = phong_lobe(down, viewer, 2.5), across = phong_lobe(side, viewer, 0.0),
               over_one = phong_lobe(longer, viewer, 1e9);
  const float naive_behind = naive_lobe(down, viewer, 2.5), naive_across = naive_lobe(side, viewer, 0.0),
              naive_over = naive_lobe(longer, viewer, 1e9);
  const auto not_finite = [](double a, double b, double c) {
    return static_cast<double>(!std::isfinite(a)) + !std::isfinite(b) + !std::isfinite(c);
  };
  return {{at_most(0, "lobes not finite", not_finite(behind, across, over_one)),
           at_most(0, "R.V = -0.1, n = 2.5: the lobe", behind), at_most(0, "R.V = 0, n = 0: the lobe", across),
           within(1e-5, "R.V = 1 + 1e-7, n = 1e9: the lobe, off 1 by", over_one, 1.0)},
          {at_most(0, "lobes not finite", not_finite(naive_behind, naive_across, naive_over)),
           at_most(0, "R.V = 0, n = 0: the lobe", naive_across)}};
}

Outcome needle_lobe(const Context& context) {
  const int size = context.is_quick ? 64 : 256;
  double worst = 0.0, naive_worst = 0.0;
  for (const double n : {1e9, 1e12}) {
    const Apart apart = apart_at_points(context, n, size);
    note(worst, apart.ours);
    note(naive_worst, apart.in_double);
  }
  return {{at_most(1e-4, "(1 - 2 s^2)^n, off by", worst)}, {at_most(1e-4, "(1 - 2 s^2)^n, off by", naive_worst)}};
}

}  // namespace tilelight::check
