// SPDX-License-Identifier: Apache-2.0
// M: glass in the air: trees of rays, and paths through many interfaces.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

#include "renderer/base/elementary.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/kit/rays.h"
#include "renderer/check/rows/bounces.h"

namespace tilelight::check {
namespace {

const std::string kClear = R"({"ambient": 0, "diffuse": 0, "transmission": 1)";  // an open brace for more

// Half of what a ball gets is mirrored, half goes in: a tree of 2^(D + 1) rays inside the first ball alone.
std::string glass_balls(int size, int ray_budget) {
  std::string objects;
  Random random(2);
  for (int i = 0; i < 20; ++i) {
    objects += (i ? ", " : "") + std::string(R"({"type": "sphere", "material": "glass", "radius": 0.4, "center": [)") +
               text(random.between(-1.0, 1.0)) + ", " + text(random.between(-1.0, 1.0)) + ", " +
               text(random.between(-1.0, 1.0)) + "]}";
  }
  std::string view = long_paths(size, 1.5, kFront, kBackward, 50);
  view.insert(view.find("\"weight_cutoff\""), "\"ray_budget\": " + text(ray_budget) + ", ");
  return "{" + view + R"("materials": {"glass": {"ambient": 0, "diffuse": 0, "reflection": 0.5, "transmission": 0.5}},
    "objects": [)" +
         objects + "]}";
}

}  // namespace

// Under a white sky every ray that is traced to its end brings 1: the value is 1 less what was left untraced.
Outcome glass_tree(const Context& context) {
  constexpr int kBudget = 4096, kServersLimit = 65536;
  const int size = context.is_quick ? 4 : 8;
  const std::string json = glass_balls(size, kBudget);
  const PathScene scene(json, context.pool);
  const double apart = worst_path(scene, context.pool,
                                  [](const Path& path) { return std::abs(path.color.r + path.untraced_weight - 1.0); });
  const double spent =
      worst_path(scene, context.pool, [](const Path& path) { return static_cast<double>(path.spent); });
  const std::clock_t start = std::clock();
  (void)picture_of(scene_of(json), context.pool);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  const PathScene unbounded(glass_balls(1, kServersLimit), context.pool);
  return {{at_most(1e-5, "value + weight left untraced, off 1 by", apart), at_most(kBudget, "rays a sample", spent),
           at_most(2 * kSlowdown, "processor time, s", seconds)},
          {at_most(kBudget, "rays a sample", static_cast<double>(unbounded.path(0, 0).spent))}};
}

Outcome furnace(const Context& context) {
  const int size = context.is_quick ? 32 : 96;
  const PathScene scene("{" + long_paths(size, 4.5, kFront, kBackward, 10) + R"("materials": {
      "glass": {"ambient": 0, "diffuse": 0, "reflection": 0.1, "transmission": 0.9},
      "bubble": {"ambient": 0, "diffuse": 0, "reflection": 0.1, "transmission": 0.9, "ior": 0.667},
      "fresnel": {"ambient": 0, "diffuse": 0, "reflection": 1, "transmission": 1, "fresnel": true}},
    "objects": [{"type": "sphere", "center": [-1, 1, 0], "material": "glass"},
      {"type": "sphere", "center": [1, 1, 0], "material": "bubble"},
      {"type": "sphere", "center": [-1, -1, 0], "material": "fresnel"},
      {"type": "sphere", "center": [-1, -1, 0], "radius": 0.5, "material": "bubble"},
      {"type": "cube", "center": [1, -1, 0], "size": 1.2, "material": "glass",
       "rotate_deg": {"axis": [1, 2, 3], "angle": 40}}]})",
                        context.pool);
  const double apart = worst_path(
      scene, context.pool, [](const Path& path) { return std::abs(path.color.r - (1.0 - path.untraced_weight)); });
  const Picture alike = picture_of(scene_of("{" + long_paths(size, 4.5, kFront, kBackward, 10) + R"("objects": [
        {"type": "sphere", "center": [-1, 0, 0], "material": )" +
                                            kClear + R"(, "ior": 1}},
        {"type": "cube", "center": [1, 0, 0], "rotate_deg": {"axis": [1, 2, 3], "angle": 40}, "material": )" +
                                            kClear + R"(, "ior": 1, "reflection": 1, "fresnel": true}}]})"),
                                   context.pool);
  const auto not_one = std::count_if(alike.linear.begin(), alike.linear.end(), [](float v) { return v != 1.0f; });
  // The bubble reflects all that comes to its limb; there the textbook goes on with kr = 0.1 alone.
  constexpr uint32_t kBubble = 1;
  const Vec3 middle(1.0, 1.0, 0.0);
  const double naive_apart = worst_path(scene, context.pool, [&](const Path& path) {
    const PathRay& first = path.rays[0];
    if (!first.is_hit() || first.body() != kBubble) return 0.0;
    const bool is_total =
        naive_refract(Vec3f(first.direction), Vec3f(first.hit_point - middle), 1.0f / 0.667f) == Vec3f(0.0f);
    return is_total ? 1.0 - 0.1 : 0.0;
  });
  return {{at_most(1e-5, "value against 1 - weight left untraced, off by", apart),
           at_most(0, "ior 1: values that are not 1 to the last bit", static_cast<double>(not_one))},
          {at_most(1e-5, "value after a total reflection, off 1 by", naive_apart)}};
}

// The same bubble twice: air in glass, and a ball of 1 / 1.5 in the air.
Outcome bubble(const Context& context) {
  const std::string view = "{" + long_paths(context.is_quick ? 32 : 96, 1.9, kFront, kBackward, 2);
  const PathScene in_glass(view + R"("objects": [{"type": "box", "min": [-9, -9, -9], "max": [9, 9, 9], "material": )" +
                               kClear + R"(, "ior": 1.5}}, {"type": "sphere", "material": )" + kClear +
                               R"(, "ior": 1}}]})",
                           context.pool);
  const PathScene in_air(
      view + R"("objects": [{"type": "sphere", "material": )" + kClear + R"(, "ior": 0.66666666666666663}}]})",
      context.pool);
  double worst = 0.0;
  const int size = in_air.plan().view.image.width;
  for (int pixel = 0; pixel < size * size; ++pixel) {
    const Path a = in_glass.path(pixel % size, pixel / size), b = in_air.path(pixel % size, pixel / size);
    for (size_t i = 0; i < b.rays.size(); ++i)
      note(worst, i < a.rays.size() ? glm::length(a.rays[i].direction - b.rays[i].direction) : INFINITY);
  }
  int accepted = 0;
  for (const char* ior : {"0", "-1"}) {
    const auto parsed = parse_scene(
        std::string(R"({"objects": [{"type": "sphere", "material": {"transmission": 1, "ior": )") + ior + "}}]}",
        Limits{});
    accepted += parsed || parsed.error().errors.front().pointer != "/objects/0/material/ior";
  }
  const Vec3f d(0.0f, 0.0f, -1.0f), n = glm::normalize(Vec3f(0.5f, 0.0f, 0.8f));
  const double naive = glm::length(naive_refract(d, n, 1.5f) - naive_refract(d, n, 1.0f / 1.5f));
  return {{at_most(1e-6, "directions in the two bubbles, apart by", worst),
           at_most(0, "documents with ior 0 or -1 accepted", accepted)},
          {at_most(1e-6, "directions in the two bubbles, apart by", naive)}};
}

namespace {

constexpr int kPlates = 100;
constexpr double kPlate = 1e-2, kGap = 1e-5, kIor = 1.5;

// Through the plates in float, each ray lifted off its interface by 1e-4: gaps thinner than that are passed over.
Vec3f naive_plates(double theta) {
  Vec3f direction(Vec3(elementary::sin(theta), 0.0, -elementary::cos(theta)));
  float z = 5.0f;
  for (int guard = 0; guard < 3 * kPlates && direction.z < 0.0f; ++guard) {
    int next = 0;
    const auto place = [](int i) { return static_cast<float>(-(i / 2) * (kPlate + kGap) - (i % 2) * kPlate); };
    while (next < 2 * kPlates && !(place(next) < z)) ++next;
    if (next == 2 * kPlates) break;
    direction = naive_refract(direction, Vec3f(0, 0, 1), static_cast<float>(next % 2 ? kIor : 1.0 / kIor));
    z = place(next) + 1e-4f * direction.z;
  }
  return direction;
}

}  // namespace

Outcome plates(const Context& context) {
  std::string objects;
  for (int i = 0; i < kPlates; ++i) {
    const double top = -i * (kPlate + kGap);
    objects += (i ? ", " : "") + std::string(R"({"type": "box", "material": "clear", "min": [-50, -50, )") +
               text(top - kPlate) + R"(], "max": [50, 50, )" + text(top) + "]}";
  }
  double bent = 0.0, shifted = 0.0, naive_bent = 0.0;
  for (const double theta : {0.3, 0.9, 1.3}) {
    const double sine = elementary::sin(theta), cosine = elementary::cos(theta);
    const Vec3 direction(sine, 0.0, -cosine);
    const PathScene scene("{" + long_paths(8, 1.0, -5.0 * direction, direction, 2 * kPlates + 10) +
                              R"("materials": {"clear": )" + kClear + R"(, "ior": 1.5}}, "objects": [)" + objects +
                              "]}",
                          context.pool);
    const double shift = kPlates * kPlate * sine * (1.0 - cosine / std::sqrt(kIor * kIor - sine * sine));
    note(bent, worst_path(scene, context.pool, [](const Path& path) {
           return glm::length(path.rays.back().direction - path.rays.front().direction);
         }));
    note(shifted, worst_path(scene, context.pool, [&](const Path& path) {
           const Vec3 d = path.rays.front().direction;
           const Vec3 way = path.rays.back().origin - path.rays.front().origin;
           return std::abs(glm::length(way - glm::dot(way, d) * d) - shift);
         }));
    note(naive_bent, glm::length(Vec3(naive_plates(theta)) - direction));
  }
  return {{at_most(1e-5, "exit against entry, direction off by", bent), at_most(1e-5, "shift, off by", shifted)},
          {at_most(1e-5, "exit against entry, direction off by", naive_bent)}};
}

// Deviation of a ray at the height h: 2 (i - r), sin i = h, sin r = h / n.
Outcome ball_lens(const Context& context) {
  const PathScene scene("{" + long_paths(context.is_quick ? 64 : 192, 2.0, kFront, kBackward, 2) +
                            R"("objects": [{"type": "sphere", "material": )" + kClear + R"(, "ior": 1.5}}]})",
                        context.pool);
  const auto deviation = [](double h) { return 2.0 * (arcsine(h) - arcsine(h / kIor)); };
  const double worst = worst_path(scene, context.pool, [&](const Path& path) {
    if (!path.rays[0].is_hit()) return 0.0;
    const double h = glm::length(Vec2(path.rays[0].origin));
    return std::abs(angle_between(path.rays.back().direction, path.rays[0].direction) - deviation(h));
  });
  double naive_worst = 0.0;
  for (double h = 0.01; h < 1.0; h += 0.01) {
    naive::RayF ray{Vec3f(static_cast<float>(h), 0.0f, 5.0f), Vec3f(0.0f, 0.0f, -1.0f)};
    for (const float eta : {1.0f / 1.5f, 1.5f}) {
      const auto t = naive::sphere(ray, Vec3f(0.0f), 1.0f, 1e-3f);
      if (!t) break;
      const Vec3f place = ray.origin + *t * ray.direction;
      ray = {place, naive_refract(ray.direction, eta < 1.0f ? place : -place, eta)};
    }
    note(naive_worst, std::abs(angle_between(Vec3(ray.direction), kBackward) - deviation(h)));
  }
  return {{at_most(1e-9, "deviation 2 (i - r), rad off", worst)},
          {at_most(1e-9, "deviation 2 (i - r), rad off", naive_worst)}};
}

}  // namespace tilelight::check
