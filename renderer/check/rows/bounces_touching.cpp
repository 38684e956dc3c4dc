// SPDX-License-Identifier: Apache-2.0
// M: media that share faces, and facets that stand for curved glass.
#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/base/elementary.h"
#include "renderer/check/kit/meshes.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/rows/bounces.h"

namespace tilelight::check {
namespace {

constexpr double kGlass = 1.5, kWater = 1.33;

std::string slab(double low, double high, double ior) {
  return R"({"type": "box", "min": [-9, )" + text(low) + R"(, -9], "max": [9, )" + text(high) +
         R"(, 9], "material": {"ambient": 0, "diffuse": 0, "transmission": 0.9, "ior": )" + text(ior) + "}}";
}

// A wheel of flat sides with normals interpolated along them, in the plane: does a ray that comes in at `height` leave
// by Snell's law at these normals alone, within this many surfaces?
bool leaves_wheel(int sides, double height, int surfaces) {
  const double half = 3.14159265358979324 / sides;
  std::vector<Vec2> corner;
  for (int i = 0; i < sides; ++i) corner.emplace_back(elementary::cos(2.0 * half * i), elementary::sin(2.0 * half * i));
  Vec2 at(-2.0, height), way(1.0, 0.0);
  int left = -1;
  for (int bounce = 0; bounce < surfaces; ++bounce) {
    double nearest = INFINITY;
    int met = -1;
    for (int i = 0; i < sides; ++i) {
      const Vec2 &a = corner[static_cast<size_t>(i)], edge = corner[static_cast<size_t>((i + 1) % sides)] - a;
      const double across = way.x * edge.y - way.y * edge.x;
      const double t = ((a.x - at.x) * edge.y - (a.y - at.y) * edge.x) / across;
      const double along = ((a.x - at.x) * way.y - (a.y - at.y) * way.x) / across;
      if (i != left && t > 0.0 && t < nearest && along >= 0.0 && along <= 1.0) nearest = t, met = i;
    }
    if (met < 0) return true;
    at += nearest * way;
    const Vec2 normal = glm::normalize(at) * (left < 0 ? 1.0 : -1.0);  // that of the circle
    const double eta = left < 0 ? 1.0 / kGlass : kGlass, cosine = -glm::dot(way, normal);
    const double k = 1.0 - eta * eta * (1.0 - cosine * cosine);
    if (left >= 0 && k >= 0.0) return true;
    way = k < 0.0 ? way + 2.0 * cosine * normal : eta * way + (eta * cosine - std::sqrt(k)) * normal;
    left = met;
  }
  return false;
}

}  // namespace

// From glass into the water under it: n sin stays, also where the glass alone would reflect all.
Outcome touching_media(const Context& context) {
  double bent = 0.0, differing = 0.0;
  int64_t rays = 0, naive_reflected = 0;
  for (double theta = 0.05; theta < 1.0; theta += 0.05) {  // total into the water: 1.09; into air: 0.73
    const Vec3 direction(elementary::sin(theta), -elementary::cos(theta), 0.0);
    for (const bool is_reversed : {false, true}) {
      const std::string glass = slab(0.1 + 0.2, 1.0, kGlass), water = slab(-1.0, 0.3, kWater);
      const std::string json = "{" + long_paths(2, 1e-3, Vec3(0.0, 0.31, 0.0), direction, 1) + R"("objects": [)" +
                               (is_reversed ? water + ", " + glass : glass + ", " + water) + "]}";
      note(bent, worst_path(PathScene(json, context.pool), context.pool, [&](const Path& path) {
             if (path.rays.size() != 2 || path.rays[1].kind != 't') return static_cast<double>(INFINITY);
             return std::abs(kGlass * path.rays[0].direction.x - kWater * path.rays[1].direction.x);
           }));
      note(differing, differing_paths(json, context.pool));
    }
    ++rays;
    naive_reflected += naive_refract(Vec3f(direction), Vec3f(0, 1, 0), static_cast<float>(kGlass)) == Vec3f(0.0f);
  }
  return {{at_most(1e-12, "n sin on both sides of the face, in either order, apart by", bent),
           at_most(0, "paths that meet other surfaces than the reference's", differing)},
          {at_most(0, "rays that a layer of air would reflect, %", percent(naive_reflected, rays))}};
}

// Whatever comes into a ball that facets stand for comes out again, and under a white sky all is white.
Outcome curved_facets(const Context& context) {
  const int size = context.is_quick ? 48 : 160;
  double trapped = 0.0, apart = 0.0, differing = 0.0;
  for (int levels = 0; levels < (context.is_quick ? 3 : 5); ++levels) {
    for (const double ior : {1.05, 1.5, 2.4}) {
      for (const bool is_fresnel : {false, true}) {
        const std::string json = "{" + long_paths(size, 2.1, kFront, kBackward, 7) + R"("meshes": {"ball": )" +
                                 mesh_text(icosphere(levels), R"(,"crease_deg": 180)") +
                                 R"(}, "objects": [{"type": "mesh", "mesh": "ball",
              "rotate_deg": {"axis": [1, 2, 3], "angle": 40}, "material": {"ambient": 0, "diffuse": 0,
              "reflection": )" + (is_fresnel ? "1" : "0") +
                                 R"(, "transmission": 1, "fresnel": )" + (is_fresnel ? "true" : "false") +
                                 R"(, "ior": )" + text(ior) + "}}]}";
        const PathScene scene(json, context.pool);
        if (!is_fresnel)
          note(trapped, worst_path(scene, context.pool, [](const Path& path) { return path.untraced_weight; }));
        note(apart, worst_path(scene, context.pool,
                               [](const Path& path) { return std::abs(path.color.r + path.untraced_weight - 1.0); }));
        if (levels == 2) differing += differing_paths(json, context.pool);
      }
    }
  }
  int64_t inside = 0;
  constexpr int kRays = 2000;
  for (int i = 0; i < kRays; ++i) inside += !leaves_wheel(20, 2.0 * (i + 0.5) / kRays - 1.0, 7);
  return {{at_most(0, "weight that is still inside after 7 surfaces", trapped),
           at_most(1e-5, "value + weight left untraced, off 1 by", apart),
           at_most(0, "paths that meet other surfaces than the reference's", differing)},
          {at_most(0, "rays that are still inside a wheel of 20 sides after 7 surfaces, %", percent(inside, kRays))}};
}

}  // namespace tilelight::check
