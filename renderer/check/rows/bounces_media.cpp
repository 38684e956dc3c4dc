// SPDX-License-Identifier: Apache-2.0
// M: media that overlap, lie inside each other, or hold the start of some rays only.
#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/check/kit/pictures.h"
#include "renderer/check/kit/rays.h"
#include "renderer/check/rows/bounces.h"

namespace tilelight::check {
namespace {

std::string medium(double ior, int priority, double reflection) {
  return R"("material": {"ambient": 0, "diffuse": 0, "reflection": )" + text(reflection) + R"(, "transmission": )" +
         text(1.0 - reflection) + R"(, "ior": )" + text(ior) + R"(, "priority": )" + text(priority) + "}}";
}

std::string ball(const Vec3& center, double radius, const std::string& material) {
  return R"({"type": "sphere", "center": [)" + text(center.x) + ", " + text(center.y) + ", " + text(center.z) +
         R"(], "radius": )" + text(radius) + ", " + material;
}

constexpr int kBalls = 12;

// The lower i, the higher: priorities are i % 4, and equals fall to the lower body.
int priority_order(int i) { return i % 4 * kBalls + (kBalls - 1 - i); }

// Along straight ways through the balls, the part that a stack, pushed at entries and popped at exits whatever lies on
// it, puts into another ball than priorities do.
double percent_of_stack_wrong(const RayScene& scene, const std::vector<Vec4>& spheres, int size) {
  int64_t ways = 0, wrong = 0;
  for (int i = 0; i < size * size; ++i) {
    Vec3 at = kFront + 2.5 * Vec3((i % size + 0.5) / size - 0.5, (i / size + 0.5) / size - 0.5, 0.0);
    std::vector<int> stack;
    for (RayScene::Hit hit; (hit = scene.nearest(at, kBackward)).is_hit;) {
      const auto met = static_cast<int>(hit.id >> 32);
      if (std::find(stack.begin(), stack.end(), met) == stack.end())
        stack.push_back(met);
      else
        stack.pop_back();
      at += (hit.t + 1e-9) * kBackward;
      const Vec3 middle = at + 0.5 * scene.nearest(at, kBackward).t * kBackward;
      int truth = -1;
      for (int k = 0; k < kBalls; ++k) {
        const Vec4& s = spheres[static_cast<size_t>(k)];
        if (glm::length(middle - Vec3(s)) < s.w && (truth < 0 || priority_order(k) > priority_order(truth))) truth = k;
      }
      ++ways;
      wrong += (stack.empty() ? -1 : stack.back()) != truth;
    }
  }
  return percent(wrong, ways);
}

}  // namespace

// Two slabs share their middle: the one of the higher priority is there (Schmidt and Budge 2002).
Outcome overlapping_media(const Context& context) {
  const int size = context.is_quick ? 24 : 64;
  const PathScene slabs("{" + long_paths(8, 1.0, Vec3(3.0, 0.0, 5.0), Vec3(-0.6, 0.0, -1.0), 8) + R"("objects": [
      {"type": "box", "min": [-9, -9, -2], "max": [9, 9, 0], )" +
                            medium(1.5, 2, 0.0) + R"(,
      {"type": "box", "min": [-9, -9, -3], "max": [9, 9, -1], )" +
                            medium(1.33, 1, 0.0) + "]}",
                        context.pool);
  const std::vector<double> places = {0.0, -2.0, -3.0};
  const double misplaced = worst_path(slabs, context.pool, [&](const Path& path) {
    if (path.rays.size() != 1 + places.size()) return static_cast<double>(INFINITY);
    double worst = glm::length(path.rays.back().direction - path.rays.front().direction);
    for (size_t i = 0; i < places.size(); ++i) note(worst, std::abs(path.rays[i].hit_point.z - places[i]));
    return worst;
  });
  std::string balls;
  Random random(7);
  std::vector<Vec4> spheres;  // centre, radius
  for (int i = 0; i < kBalls; ++i) {
    const Vec3 center = 0.7 * random.direction();
    spheres.emplace_back(center, random.between(0.5, 0.9));
    balls += (i ? ", " : "") + ball(center, spheres.back().w, medium(random.between(1.0, 2.0), i % 4, 0.1));
  }
  const std::string json = "{" + long_paths(size, 2.5, kFront, kBackward, 5) + R"("objects": [)" + balls + "]}";
  return {{at_most(1e-12, "interfaces of the slabs, out of place by", misplaced),
           at_most(0, "paths that meet other surfaces than the reference's", differing_paths(json, context.pool))},
          {at_most(0, "ways of primary rays in the wrong medium, %",
                   percent_of_stack_wrong(RayScene(json, context.pool), spheres, size))}};
}

// The image plane cuts a ball in halves: rays near the middle start in glass, the others in the air. A great ball
// before them bends the latter by i - r, sin i = s / 3.
Outcome plane_through_glass(const Context& context) {
  const std::string glass = medium(1.5, 0, 0.0);
  const std::string json = "{" + long_paths(context.is_quick ? 48 : 128, 4.0, Vec3(0.0), kBackward, 6) +
                           R"("objects": [)" + ball(Vec3(0.0), 1.0, glass) + ", " +
                           ball(Vec3(0.0, 0.0, -5.0), 3.0, glass) + "]}";
  const PathScene scene(json, context.pool);
  double naive_worst = 0.0;
  const double worst = worst_path(scene, context.pool, [&](const Path& path) {
    const double s = glm::length(Vec2(path.rays[0].origin));
    const double turned = angle_between(path.rays[0].direction, path.rays[1].direction);
    if (s < 1.0 / 1.5) return std::abs(turned - (arcsine(1.5 * s) - arcsine(s)));
    return s > 1.0 ? std::abs(turned - (arcsine(s / 3.0) - arcsine(s / 4.5))) : 0.0;
  });
  // From glass, as the eye's own place has it, into glass: straight on.
  for (double s = 1.01; s < 2.8; s += 0.01) note(naive_worst, arcsine(s / 3.0) - arcsine(s / 4.5));
  return {{at_most(1e-9, "first bend of a ray, rad off", worst),
           at_most(0, "paths that meet other surfaces than the reference's", differing_paths(json, context.pool))},
          {at_most(1e-9, "first bend of a ray, rad off", naive_worst)}};
}

// n r sin(angle to the centre) stays what it is from shell to shell (Bouguer), so all that a ray does is known.
Outcome nested_media(const Context& context) {
  constexpr int kMedia = 20;
  const auto radius = [](int k) { return 1.0 - 0.03 * k; };
  const auto ior = [](int k) { return k < 0 ? 1.0 : 1.05 + 0.05 * k; };
  std::string balls;
  for (int k = 0; k < kMedia; ++k) balls += (k ? ", " : "") + ball(Vec3(0.0), radius(k), medium(ior(k), 0, 0.0));
  const std::string json = "{" + long_paths(context.is_quick ? 16 : 48, 0.5, kFront, kBackward, 3 * kMedia) +
                           R"("objects": [)" + balls + "]}";
  const PathScene scene(json, context.pool);
  const auto bend = [&](double b) {
    double sum = 0.0;
    for (int k = 0; k < kMedia; ++k)
      sum += 2.0 * (arcsine(b / (ior(k - 1) * radius(k))) - arcsine(b / (ior(k) * radius(k))));
    return sum;
  };
  const double miscounted = worst_path(scene, context.pool, [](const Path& path) {
    return std::abs(static_cast<double>(path.rays.size()) - 1.0 - 2.0 * kMedia);
  });
  const double worst = worst_path(scene, context.pool, [&](const Path& path) {
    const double b = glm::length(Vec2(path.rays[0].origin));
    return std::abs(angle_between(path.rays[0].direction, path.rays.back().direction) - bend(b));
  });
  // The same paths with a list of 16: what finds no room in it is not entered, and so it is not there.
  const double naive_miscounted = worst_path(scene, context.pool, [&](const Path& path) {
    std::vector<uint32_t> listed;
    int met = 0;
    for (const PathRay& ray : path.rays) {
      if (!ray.is_hit()) continue;
      const auto place = std::find(listed.begin(), listed.end(), ray.body());
      if (place != listed.end())
        listed.erase(place), ++met;
      else if (listed.size() < 16)
        listed.push_back(ray.body()), ++met;
    }
    return std::abs(met - 2.0 * kMedia);
  });
  return {{at_most(0, "interfaces, other than 40 by", miscounted), at_most(1e-9, "bend of the whole, rad off", worst),
           at_most(0, "paths that meet other surfaces than the reference's", differing_paths(json, context.pool))},
          {at_most(0, "interfaces, other than 40 by", naive_miscounted)}};
}

}  // namespace tilelight::check
