// SPDX-License-Identifier: Apache-2.0
// M: mirrors alone.
#include <algorithm>
#include <cmath>

#include "renderer/base/elementary.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/rows/bounces.h"

namespace tilelight::check {
namespace {

// Two facing mirrors, the eye between them. `more`: members that set the eye's look and the render.
std::string between_mirrors(const std::string& more, double reflection) {
  return "{" + more + R"("materials": {"mirror": {"ambient": 1, "diffuse": 0, "reflection": )" + text(reflection) +
         R"(}}, "objects": [{"type": "plane", "point": [0, 0, 1], "normal": [0, 0, -1], "material": "mirror"},
                            {"type": "plane", "point": [0, 0, -1], "normal": [0, 0, 1], "material": "mirror"}]})";
}

}  // namespace

// Each surface glows with a = 0.1: a (1 - kr^(D + 1)) / (1 - kr), and what is missing of the whole series is told.
Outcome facing_mirrors(const Context& context) {
  constexpr double kGlow = 0.1;
  constexpr int kTextbookDepth = 5;
  const auto rendered = [&](double kr, int depth) {
    return picture_of(scene_of(between_mirrors(R"("lights": [], "ambient": 0.1, "background": {"bottom": 0, "top": 0},
        "camera": {"position": [0, 0, 0], "target": [0, 0, -1]}, "image": {"width": 2, "height": 2},
        "render": {"weight_cutoff": 0, "max_depth": )" +
                                                   text(depth) + "}, ",
                                               kr)),
                      context.pool);
  };
  double worst = 0.0, naive_worst = 0.0, least = INFINITY;
  for (const double kr : {0.5, 0.9, 0.99}) {
    for (const int depth : {5, 50, 1000}) {
      const Picture picture = rendered(kr, depth), textbook = rendered(kr, std::min(depth, kTextbookDepth));
      const double expected = kGlow * (1.0 - elementary::pow(kr, depth + 1.0)) / (1.0 - kr);
      const double missing = kGlow * elementary::pow(kr, depth + 1.0) / (1.0 - kr);
      note(worst, std::abs(picture.linear[0] / expected - 1.0));
      note(naive_worst, std::abs(textbook.linear[0] / expected - 1.0));
      least = std::min(least, picture.report.points.back().truncation_bound / missing);
    }
  }
  return {{at_most(1e-5, "a (1 - kr^(D + 1)) / (1 - kr), relative error", worst),
           at_least(1.0, "reported bound over what is missing", least)},
          {at_most(1e-5, "a (1 - kr^(D + 1)) / (1 - kr), relative error", naive_worst)}};
}

// Three mirrors at right angles send every ray back the way it came.
Outcome corner_cube(const Context& context) {
  const std::string turned = R"("rotate_deg": {"axis": [1, 2, 3], "angle": 37}, "material": {"reflection": 1}})";
  const auto plane = [&](const std::string& normal) {
    return R"({"type": "plane", "normal": )" + normal + ", " + turned;
  };
  // Into the corner, as the mirrors are turned, from all over the square of a view.
  const double half = elementary::rad_from_deg(0.5 * 37.0);
  const glm::dquat turn(elementary::cos(half), elementary::sin(half) * glm::normalize(Vec3(1.0, 2.0, 3.0)));
  const Vec3 into = turn * glm::normalize(Vec3(-1.0, -1.1, -0.9));
  const PathScene scene("{" + long_paths(context.is_quick ? 32 : 128, 1.0, turn * Vec3(3.0), into, 50) +
                            R"("objects": [)" + plane("[1, 0, 0]") + ", " + plane("[0, 1, 0]") + ", " +
                            plane("[0, 0, 1]") + "]}",
                        context.pool);
  const double worst = worst_path(scene, context.pool, [](const Path& path) {
    return path.rays.size() == 4 ? glm::length(path.rays[0].direction + path.rays[3].direction) : INFINITY;
  });
  Vec3f naive(into);
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
    const Vec3f n(turn * axis);
    naive -= 2.0f * glm::dot(naive, n) * n;
  }
  return {{at_most(1e-12, "entry + exit after three mirrors, length", worst)},
          {at_most(1e-12, "entry + exit after three mirrors, length", glm::length(into + Vec3(naive)))}};
}

Outcome thousand_mirrors(const Context& context) {
  constexpr int kMirrors = 1000;
  const PathScene scene(between_mirrors(long_paths(2, 1.0, Vec3(0.0), Vec3(0.1, 0.2, -1.0), kMirrors), 0.999),
                        context.pool);
  const double expected = elementary::exp(kMirrors * elementary::log1p(0.999 - 1.0));
  const double worst = worst_path(scene, context.pool, [&](const Path& path) {
    if (path.rays.size() != kMirrors + 1) return static_cast<double>(INFINITY);
    return std::abs(path.rays.back().weight.r / expected - 1.0);
  });
  float naive = 1.0f;
  for (int i = 0; i < kMirrors; ++i) naive *= 0.999f;
  return {{at_most(1e-9, "0.999^1000, relative error", worst)},
          {at_most(1e-9, "0.999^1000, relative error", std::abs(naive / expected - 1.0))}};
}

}  // namespace tilelight::check
