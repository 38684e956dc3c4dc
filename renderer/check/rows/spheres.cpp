// SPDX-License-Identifier: Apache-2.0
// S: spheres far, huge, tiny, grazed, and seen from inside.
#include "renderer/check/rows/spheres.h"

#include <cmath>
#include <string>

#include "renderer/check/kit/naive.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/kit/shots.h"

namespace tilelight::check {
namespace {

// From the centre of the unit sphere every ray meets it at t = 1.
Outcome inside(const Context& context) {
  const RayScene scene(R"({"objects": [{"type": "sphere"}]})", context.pool);
  const Tally tally =
      tally_shots(context.pool, context.is_quick ? 50'000 : 2'000'000, 3, [&](Random& random, Tally& to) {
        const Vec3 direction = random.direction();
        const RayScene::Hit hit = scene.nearest(Vec3(0.0), direction);
        to.wrong += !hit.is_hit;
        note(to.worst, std::abs(hit.t - 1.0));
        // The rule "the smaller root, then its sign" takes the one behind the eye.
        const auto root = naive::smaller_root({Vec3f(0.0f), Vec3f(direction)}, Vec3f(0.0f), 1.0f);
        to.naive_wrong += !(root && *root > 0.0f);
      });
  return {{at_most(0, "rays that miss", tally.wrong), at_most(1e-6, "t, off by", tally.worst)},
          {at_most(0, "rays that miss", tally.naive_wrong)}};
}

// A ray meets a sphere iff it passes the centre at less than a radius. Only so near to the radius may one err.
Outcome grazed(const Context& context) {
  const SphereShape ball{{3.7, -1.2, 5.1}, 2.3};
  const RayScene scene(scene_of_shapes({ball}), context.pool);
  constexpr double kReach = 1e-6, kBand = 4e-7;
  const Tally tally = tally_shots(context.pool, context.is_quick ? 20'000 : 100'000, 7, [&](Random& random, Tally& to) {
    const Vec3 direction = random.direction();
    const double off = random.between(-kReach, kReach), before = ball.radius * random.between(2.0, 1000.0);
    const Vec3 origin = ball.center + ball.radius * (1.0 + off) * across(direction, random) - before * direction;
    const bool is_hit = off < 0.0;
    if (scene.nearest(origin, direction).is_hit != is_hit) {
      to.wrong += std::abs(off) > kBand;
      note(to.worst, std::abs(off));
    }
    const auto t = naive::sphere({Vec3f(origin), Vec3f(direction)}, Vec3f(ball.center), 2.3f, 0.0f);
    if (t.has_value() != is_hit) {
      to.naive_wrong += std::abs(off) > kBand;
      note(to.naive_worst, std::abs(off));
    }
  });
  const std::string what = "rays told wrong outside r (1 +- 4e-7)", band = "farthest from r of a wrong ray, radii";
  return {{at_most(0, what, tally.wrong), at_most(kBand, band, tally.worst)},
          {at_most(0, what, tally.naive_wrong), at_most(kBand, band, tally.naive_worst)}};
}

// The same bodies, made larger by 1 / scale and scaled back by their instances: a ball of glass, a cube, a tetrahedron.
ParsedScene scaled_back(const std::string& larger, const std::string& scale) {
  return scene_of(R"({"image": {"width": 320, "height": 240},
    "camera": {"position": [1.5, 2.5, 6], "target": [0, 0.4, 0], "fov_y_deg": 35},
    "meshes": {"tetra": {"positions": [0,0,0, )" +
                  larger + ",0,0, 0," + larger + ",0, 0,0," + larger + R"(],
                         "indices": [0,2,1, 0,1,3, 0,3,2, 1,2,3]}},
    "materials": {"glass": {"diffuse": 0.1, "specular": 0.5, "reflection": 0.2, "transmission": 0.7}},
    "objects": [{"type": "plane", "point": [0, -1, 0], "material": {"diffuse": {"checker": {"size": 1}}}},
      {"type": "sphere", "center": [-0.8, 0, 1], "radius": )" +
                  larger + R"(, "material": "glass", "scale": )" + scale +
                  R"(},
      {"type": "cube", "center": [1.2, -0.5, 0.5], "size": )" +
                  larger + R"(, "scale": )" + scale + R"(},
      {"type": "mesh", "mesh": "tetra", "translate": [0, 0.2, -1], "scale": )" +
                  scale + "}]}");
}

// The quadratic with A taken for 1, in the space of an instance where the ray's direction has length 1 / scale.
bool hits_as_if_unit(const Vec3f& origin, const Vec3f& direction, float radius) {
  const float b = 2.0f * glm::dot(origin, direction), c = glm::dot(origin, origin) - radius * radius;
  return b * b - 4.0f * c >= 0.0f;
}

Outcome scaled_instances(const Context& context) {
  const Picture unit = picture_of(scaled_back("1", "1"), context.pool);
  double differing = 0.0;
  for (const auto& [larger, scale] : {std::pair{"1000", "0.001"}, std::pair{"0.001", "1000"}})
    note(differing, differing_pixels(picture_of(scaled_back(larger, scale), context.pool).rgb, unit.rgb));

  constexpr int kRays = 100;  // a side; parallel rays down z, over twice the unit ball
  int64_t changed = 0;
  for (int i = 0; i < kRays * kRays; ++i) {
    const Vec3f origin(0.04f * static_cast<float>(i % kRays) - 2.0f, 0.04f * static_cast<float>(i / kRays) - 2.0f,
                       5.0f);
    const Vec3f down(0.0f, 0.0f, -1.0f);
    const bool is_hit = hits_as_if_unit(origin, down, 1.0f);
    for (const float larger : {1000.0f, 0.001f})
      changed += hits_as_if_unit(larger * origin, larger * down, larger) != is_hit;
  }
  return {{at_most(0, "pixels unlike those of scale 1, %", differing)},
          {at_most(0, "rays told otherwise than at scale 1, %",
                   100.0 * static_cast<double>(changed) / (2 * kRays * kRays))}};
}

constexpr Row kRows[] = {
    {"S1", "sphere far away", "r = 1, distance 1e4, tan(fov/2) = 2.56e-4", "b^2 - 4ac in float", far_ball},
    {"S2", "sphere farther away", "r = 1, distance 1e6, tan(fov/2) = 2.56e-6", "b^2 - 4ac in float", farther_ball},
    {"S3", "eye in the centre of a sphere", "r = 1, distance 0", "the smaller root, then its sign", inside},
    {"S4", "standing on a planet", "r = 6.371e6, eye 1.7 above", "two float forms of the quadratic", planet},
    {"S5", "shell of glass", "r = 1 and 1 - 1e-6", "rays lifted off by 1e-4, in double", glass_shell},
    {"S6", "dust on a sphere", "r = 1e-6 on r = 1, with its shadow", "float, rays lifted off by 1e-3", dust},
    {"S7", "sphere grazed", "impact parameter r (1 +- 1e-6)", "b^2 - 4ac in float", grazed},
    {"S8", "instances scaled", "|u| = 1e-3, 1, 1e3 in the instance", "the quadratic with A = 1", scaled_instances},
    {"S9", "speck far from the origin", "r = 1e-3 at 1e8, seen from 0.025", "world space in float", speck_far_away},
    {"S10", "needle grazed", "ellipsoid of axes 1e4, 1 and 1e-4, turned", "float quadratic in the body's own space",
     needle_ellipsoid},
    {"S11", "sphere as far as doubles tell", "r = 1, distance 1e12", "b^2 - 4ac in double", farthest_ball},
};

}  // namespace

std::span<const Row> sphere_rows() { return kRows; }

}  // namespace tilelight::check
