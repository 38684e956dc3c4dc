// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include "renderer/base/elementary.h"
#include "renderer/check/kit/naive.h"
#include "renderer/check/kit/paths.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/kit/shots.h"
#include "renderer/check/kit/textbook.h"
#include "renderer/check/rows/spheres.h"
#include "renderer/film/sampling.h"
#include "renderer/scene/transform.h"

namespace tilelight::check {
namespace {

using Sequence = std::vector<uint64_t>;  // the surfaces along a path, kNothingHit at its end

Sequence surfaces_of(const Path& path) {
  Sequence out;
  for (const PathRay& ray : path.rays) out.push_back(ray.id);
  return out;
}

constexpr double kShellRadii[] = {1.0, 1.0 - 1e-6};

// Where a ray from `origin` meets a sphere about the origin next, farther than epsilon; infinity if nowhere. Stable: it
// is the epsilon alone that errs.
double next_root(const Vec3& origin, const Vec3& direction, double radius, double epsilon) {
  const double b = -glm::dot(origin, direction);
  const Vec3 nearest = origin + b * direction;
  const double half2 = radius * radius - glm::dot(nearest, nearest);
  if (half2 < 0.0) return std::numeric_limits<double>::infinity();
  for (const double t : {b - std::sqrt(half2), b + std::sqrt(half2)})
    if (t > epsilon) return t;
  return std::numeric_limits<double>::infinity();
}

// The walk through the shell with every ray lifted off its surface by epsilon.
Sequence walk_by_epsilon(Vec3 origin, Vec3 direction, double inner_ior, double epsilon) {
  Sequence path;
  const double outside_ior[] = {1.0, 1.5}, inside_ior[] = {1.5, inner_ior};
  while (path.size() < 8) {
    const double t[] = {next_root(origin, direction, kShellRadii[0], epsilon),
                        next_root(origin, direction, kShellRadii[1], epsilon)};
    const uint32_t body = t[0] <= t[1] ? 0 : 1;
    if (std::isinf(t[body])) break;
    path.push_back(surface_id(body, 0));
    origin += t[body] * direction;
    Vec3 normal = glm::normalize(origin);
    const bool enters = glm::dot(normal, direction) < 0.0;
    if (!enters) normal = -normal;
    const double eta = enters ? outside_ior[body] / inside_ior[body] : inside_ior[body] / outside_ior[body];
    const double cosine = -glm::dot(direction, normal), k = 1.0 - eta * eta * (1.0 - cosine * cosine);
    direction = k < 0.0 ? direction + 2.0 * cosine * normal
                        : glm::normalize(eta * direction + (eta * cosine - std::sqrt(k)) * normal);
  }
  path.push_back(kNothingHit);
  return path;
}

struct ShellCounts {
  int64_t rays = 0, agree = 0, four = 0, naive_agree = 0;
};

// All rays inside 0.9 r, of a picture along no axis.
ShellCounts shell_counts(const std::string& inner, double inner_ior, const Context& context) {
  const int size = context.is_quick ? 64 : 256;
  ParsedScene parsed = scene_of(R"({
    "camera": {"type": "orthographic", "position": [2, 3, 6], "target": [0, 0, 0], "height": 1.8}, "lights": [],
    "objects": [{"type": "sphere", "material": {"diffuse": 0, "transmission": 1, "ior": 1.5}},
      {"type": "sphere", "radius": 0.999999, "material": {"diffuse": 0, "transmission": 1, )" +
                                inner + "}}]}");
  parsed.view.image.width = parsed.view.image.height = size;
  const PathScene scene(parsed, context.pool);
  const ReferenceScene reference(parsed.scene);
  const ReferenceEye eye = make_reference_eye(reference, parsed.view, *parsed.view.camera);

  std::vector<ShellCounts> lines(static_cast<size_t>(size));
  context.pool.parallel_for(size, Priority::batch, [&](int64_t line) {
    ShellCounts& counts = lines[static_cast<size_t>(line)];
    const auto y = static_cast<int>(line);
    for (int x = 0; x < size; ++x) {
      const SamplePoint at = sample_point(x, y, parsed.view.render.seed, 0);
      std::vector<ReferenceRay> rays;
      reference_sample(reference, eye, Vec2(x + at.x, y + at.y), &rays);
      if (glm::length(glm::cross(rays[0].origin, rays[0].direction)) > 0.9) continue;
      Sequence expected;
      for (const ReferenceRay& ray : rays) expected.push_back(ray.hit_id);
      const Sequence ours = surfaces_of(scene.path(x, y));
      ++counts.rays;
      counts.agree += ours == expected;
      counts.four +=
          ours == Sequence{surface_id(0, 0), surface_id(1, 0), surface_id(1, 0), surface_id(0, 0), kNothingHit};
      counts.naive_agree += walk_by_epsilon(rays[0].origin, rays[0].direction, inner_ior, 1e-4) == expected;
    }
  });
  ShellCounts sum;
  for (const ShellCounts& line : lines) {
    sum.rays += line.rays, sum.agree += line.agree, sum.four += line.four, sum.naive_agree += line.naive_agree;
  }
  return sum;
}

// Pixels that two renderers see, and those that at least one sees.
struct Overlap {
  int64_t both = 0, either = 0;
  void add(bool a, bool b) { both += a && b, either += a || b; }
  double percent() const { return check::percent(both, either); }
};

std::vector<ReferencePixel> reference_pixels(const ParsedScene& parsed, TilePool& pool) {
  return reference_image(ReferenceScene(parsed.scene), parsed.view, *parsed.view.camera, pool);
}

}  // namespace

// Two balls of glass one in the other, and a ball of glass that is hollow: each ray crosses four surfaces.
Outcome glass_shell(const Context& context) {
  Outcome outcome;
  struct Inner {
    const char *name, *material;
    double ior;
  };
  for (const Inner& inner :
       {Inner{"glass in glass", R"("ior": 1.5)", 1.5}, Inner{"hollow", R"("ior": 1, "priority": 1)", 1.0}}) {
    const ShellCounts counts = shell_counts(inner.material, inner.ior, context);
    const std::string what = std::string(inner.name) + ": rays that meet what the reference meets, %";
    outcome.ours.push_back(at_least(99.9, what, percent(counts.agree, counts.rays)));
    outcome.ours.push_back(
        at_least(99.9, std::string(inner.name) + ": rays of four surfaces, %", percent(counts.four, counts.rays)));
    outcome.naive.push_back(at_least(99.9, what, percent(counts.naive_agree, counts.rays)));
  }
  return outcome;
}

// A grain lies on a ball, under a light from the side; there is no ambient light, so what is shaded is black. The grain
// is a quarter of the picture wide.
Outcome dust(const Context& context) {
  ParsedScene parsed = scene_of(R"({
    "camera": {"position": [0.9, 0.7, 1.1], "target": [0.48000048, 0.6000006, 0.64000064], "fov_y_deg": 0.000725},
    "ambient": 0, "lights": [{"type": "directional", "direction": [-1, -0.2, -0.6]}],
    "objects": [{"type": "sphere"}, {"type": "sphere", "center": [0.48000048, 0.6000006, 0.64000064], "radius": 1e-6}]})");
  parsed.view.image.width = parsed.view.image.height = context.is_quick ? 128 : 512;
  const Picture picture = picture_of(parsed, context.pool);
  const std::vector<ReferencePixel> reference = reference_pixels(parsed, context.pool);
  const auto textbook = TextbookTracer(parsed.scene).picture(parsed.view, *parsed.view.camera, context.pool);

  const uint64_t ball = surface_id(0, 0), grain = surface_id(1, 0);
  Overlap grains, grains_naive, shadows, shadows_naive;
  for (size_t i = 0; i < reference.size(); ++i) {
    const bool is_grain = reference[i].primary_id == grain;
    const bool is_shaded = reference[i].primary_id == ball && reference[i].color == Color(0.0);
    grains.add(picture.ids[i] == grain, is_grain);
    grains_naive.add(textbook.ids[i] == grain, is_grain);
    shadows.add(picture.ids[i] == ball && picture.linear[3 * i] == 0.0f, is_shaded);
    shadows_naive.add(textbook.ids[i] == ball && !textbook.lit[i], is_shaded);
  }
  const std::string seen = "pixels of the grain, % of those that either sees",
                    shaded = "pixels of its shadow, % of those that either sees";
  return {{at_least(95, seen, grains.percent()), at_least(95, shaded, shadows.percent())},
          {at_least(95, seen, grains_naive.percent()), at_least(95, shaded, shadows_naive.percent())}};
}

// In the space where the ellipsoid is the unit ball, a ray meets it iff it passes the centre at less than 1: tangents
// all around, 1 +- 1e-6. The body stands turned in the world, so that every coordinate mixes the long and the thin
// axis.
Outcome needle_ellipsoid(const Context& context) {
  const Vec3 axes(1e4, 1.0, 1e-4);
  const Mat3 turn = rotation_about({1, 2, 3}, 37.0);
  Scene of_ball = scene_of_shapes({SphereShape{}});
  for (int column = 0; column < 3; ++column)
    of_ball.objects[0].world_from_shape[column] = Vec4(axes[column] * turn[column], 0.0);
  const Mat3 world_from_ball(of_ball.objects[0].world_from_shape);
  const RayScene scene(of_ball, context.pool);
  const glm::mat3 ball_from_world = glm::inverse(glm::mat3(world_from_ball));
  constexpr double kReach = 1e-6, kBand = 4e-7;
  const Tally tally =
      tally_shots(context.pool, context.is_quick ? 20'000 : 500'000, 10, [&](Random& random, Tally& to) {
        const Vec3 direction = random.direction();
        const double off = random.between(-kReach, kReach);
        const Vec3 side = across(direction, random);
        const Vec3 in_ball = (1.0 + off) * side - random.between(1.5, 4.0) * direction;
        const Vec3 origin = world_from_ball * in_ball, aim = world_from_ball * direction;
        const bool is_hit = off < 0.0;
        if (scene.nearest(origin, aim).is_hit != is_hit) {
          to.wrong += std::abs(off) > kBand;
          note(to.worst, std::abs(off));
        }
        const naive::RayF ray{ball_from_world * Vec3f(origin), ball_from_world * Vec3f(glm::normalize(aim))};
        to.naive_wrong += naive::sphere(ray, Vec3f(0.0f), 1.0f, 0.0f).has_value() != is_hit && std::abs(off) > kBand;
      });
  const std::string what = "rays told wrong outside 1 +- 4e-7";
  return {{at_most(0, what, tally.wrong), at_most(kBand, "farthest from 1 of a wrong ray", tally.worst)},
          {at_most(0, what, tally.naive_wrong)}};
}

}  // namespace tilelight::check
