// SPDX-License-Identifier: Apache-2.0
// M: media that overlap, lie inside each other, or hold the start of some rays only.
#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/check/bounces.h"
#include "renderer/check/rays.h"

namespace tilelight::check {
namespace {

std::string medium(double ior, int priority, double reflection) {
  return R"("material": {"ambient": 0, "diffuse": 0, "reflection": )" + digits(reflection) + R"(, "transmission": )" +
         digits(1.0 - reflection) + R"(, "ior": )" + digits(ior) + R"(, "priority": )" + digits(priority) + "}}";
}

std::string ball(const Vec3& center, double radius, const std::string& material) {
  return R"({"type": "sphere", "center": [)" + digits(center.x) + ", " + digits(center.y) + ", " + digits(center.z) +
         R"(], "radius": )" + digits(radius) + ", " + material;
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
  for (int i = 0; i < 12; ++i) {
    const Vec3 center = 0.7 * random.direction();
    balls += (i ? ", " : "") + ball(center, random.between(0.5, 0.9), medium(random.between(1.0, 2.0), i % 4, 0.1));
  }
  const double differing = differing_paths(
      "{" + long_paths(size, 2.5, kFront, kBackward, 5) + R"("objects": [)" + balls + "]}", context.pool);

  // Entering pushes and leaving pops, whatever is left: A, then B in it, then A ends. The truth is A, A, B.
  std::string stack, seen;
  for (const char event : {'A', 'B', '-'}) {
    if (event == '-') {
      stack.pop_back();
    } else {
      stack.push_back(event);
    }
    seen.push_back(stack.back());
  }
  const std::string truth = "AAB";
  int wrong = 0;
  for (size_t i = 0; i < truth.size(); ++i) wrong += seen[i] != truth[i];
  return {{at_most(1e-12, "interfaces of the slabs, out of place by", misplaced),
           at_most(0, "paths that meet other surfaces than the reference's", differing)},
          {at_most(0, "stretches of the slabs in the wrong medium", wrong)}};
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
  // With a list of 16 the balls inside are never entered, so their surfaces are not there.
  constexpr double kListed = 16.0;
  return {{at_most(0, "interfaces, other than 40 by", miscounted), at_most(1e-9, "bend of the whole, rad off", worst),
           at_most(0, "paths that meet other surfaces than the reference's", differing_paths(json, context.pool))},
          {at_most(0, "interfaces, other than 40 by", 2.0 * (kMedia - kListed))}};
}

}  // namespace tilelight::check
