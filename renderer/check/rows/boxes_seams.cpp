// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>
#include <string>

#include "renderer/check/kit/naive.h"
#include "renderer/check/kit/shots.h"
#include "renderer/check/rows/boxes.h"
#include "renderer/scene/transform.h"
#include "renderer/shade/surface.h"
#include "renderer/trace/trace_rays.h"

namespace tilelight::check {
namespace {

std::optional<naive::Slabs> float_slabs(const Vec3& origin, const Vec3& direction, const BoxShape& box,
                                        bool touching = true) {
  return naive::slabs({Vec3f(origin), Vec3f(direction)}, Vec3f(box.min), Vec3f(box.max), touching);
}

// Whether a lamp far away in the direction `to_light` reaches the place of a hit.
bool is_lit(const CompiledScene& scene, const Ray& ray, const Hit& hit, const Vec3& to_light) {
  const Surface surface = make_surface(scene, ray, hit);
  const BoundedRay shadow{{surface.position, to_light, surface.here, Coincident::before}};
  uint8_t is_blocked = 0;
  trace_any(scene, {&shadow, 1}, {&is_blocked, 1});
  return !is_blocked;
}

double whole(Random& random, int most) {
  return static_cast<double>(random.next() % (2u * static_cast<unsigned>(most) + 1)) - most;
}

}  // namespace

// From whole places in whole steps through a corner, which belongs to the box: along the diagonal into it, or past it
// so that the corner alone is touched.
Outcome corner(const Context& context) {
  const BoxShape box{Vec3(-1.0), Vec3(1.0)};
  const RayScene scene(scene_of_shapes({box}), context.pool);
  const auto shoot = [&](Random& random, Tally& to) {
    Vec3 corner, step;
    for (int k = 0; k < 3; ++k) corner[k] = random.next() % 2 ? 1.0 : -1.0, step[k] = whole(random, 50);
    if (random.next() % 4 == 0) step = -step.x * corner;
    if (step == Vec3(0.0)) return;
    const Vec3 origin = corner - static_cast<double>(1 + random.next() % 1000) * step;
    to.wrong += !scene.nearest(origin, step).is_hit;
    to.naive_wrong += !float_slabs(origin, step, box, false);
  };
  const Tally tally = tally_shots(context.pool, context.is_quick ? 100'000 : 2'000'000, 5, shoot);
  return {{at_most(0, "false misses", tally.wrong)}, {at_most(0, "false misses", tally.naive_wrong)}};
}

// A wall of boxes whose common faces lie at decimal places, upright and turned: the voxels of an orthographic view, met
// exactly between two of them. A ray in the seam is in both closed boxes, and from there the wall's lamp is in sight.
Outcome seams_of_boxes(const Context& context) {
  std::vector<BoxShape> boxes;
  constexpr int kBoxes = 64;
  for (int i = 0; i < kBoxes; ++i) boxes.push_back({{0.1 * i, -0.3, 0.1}, {0.1 * (i + 1), 0.4, 0.7}});
  Tally sum;
  for (const Mat3& turn : {Mat3(1.0), rotation_about({1, 2, 3}, 37.0)}) {
    Scene wall = scene_of_shapes(std::vector<Shape>(boxes.begin(), boxes.end()));
    for (Object& object : wall.objects) object.world_from_shape = Mat4(turn);
    const auto scene = compile_scene(wall, context.pool);
    const auto shoot = [&](Random& random, Tally& to) {
      const auto i = static_cast<size_t>(random.next() % (kBoxes - 1));
      Vec3 origin(boxes[i].max.x, random.between(-0.2, 0.3), 3.0), direction(0.0, 0.0, -1.0);
      if (random.next() % 2) direction.y = random.between(-0.03, 0.03);
      if (random.next() % 2) direction.x = -0.0;
      const BoundedRay ray{{(turn * origin - scene->center) / scene->units, glm::normalize(turn * direction), {}, {}}};
      Hit hit;
      trace_closest(*scene, {&ray, 1}, {&hit, 1});
      to.wrong += !hit.is_hit();
      to.also_wrong += hit.is_hit() && !is_lit(*scene, ray.ray, hit, -ray.ray.direction);
      to.naive_wrong += !float_slabs(origin, direction, boxes[i]) && !float_slabs(origin, direction, boxes[i + 1]);
    };
    sum += tally_shots(context.pool, context.is_quick ? 50'000 : 500'000, 6, shoot);
  }
  return {{at_most(0, "rays that slip through", sum.wrong),
           at_most(0, "places in the seam that are shaded", sum.also_wrong)},
          {at_most(0, "rays that slip through", sum.naive_wrong)}};
}

// The box lies flat on the cube: its top is 1e-12 nearer to the eye, four thousand times the spacing of doubles there.
Outcome tiny_box(const Context& context) {
  constexpr double kEdge = 1e-12;
  const Vec3 at(0.3, 0.5, -0.2);
  const BoxShape ground{Vec3(-0.5), Vec3(0.5)}, tiny{at, at + Vec3(kEdge)};
  const RayScene scene(scene_of_shapes({ground, tiny}), context.pool);
  const auto shoot = [&](Random& random, Tally& to) {
    const Vec3 target = at + kEdge * Vec3{random.between(0.1, 0.9), 1.0, random.between(0.1, 0.9)};
    Vec3 towards = random.direction();
    towards.y = std::abs(towards.y) + 0.1;
    const double distance = random.next() % 2 ? 1.0 : random.between(2.0, 1000.0) * kEdge;
    const Vec3 origin = target + distance * towards;
    const RayScene::Hit hit = scene.nearest(origin, target - origin);
    to.wrong += !(hit.is_hit && hit.id == (uint64_t{1} << 32 | 3));
    to.naive_wrong += !float_slabs(origin, target - origin, tiny);
  };
  const Tally tally = tally_shots(context.pool, context.is_quick ? 50'000 : 1'000'000, 7, shoot);
  const std::string what = "rays at its top that do not meet it";
  return {{at_most(0, what, tally.wrong)}, {at_most(0, what, tally.naive_wrong)}};
}

// A sheet so little above the floor that a ray which starts on it cannot tell the two apart, where the ray from the eye
// still can: the sheet is in front everywhere, and the floor behind it takes none of its light.
Outcome sheet_on_floor(const Context& context) {
  constexpr double kGap = 5e-14;
  const BoxShape floor{{-1, -1, -1}, {1, 0, 1}}, sheet{{-0.8, kGap, -0.8}, {0.8, kGap, 0.8}};
  const auto scene = compile_scene(scene_of_shapes({floor, sheet}), context.pool);
  const auto shoot = [&](Random& random, Tally& to) {
    const Vec3 target{random.between(-0.7, 0.7), kGap, random.between(-0.7, 0.7)};
    Vec3 towards = random.direction(), to_light = random.direction();
    towards.y = 0.1 + std::abs(towards.y), to_light.y = 0.1 + std::abs(to_light.y);
    const Vec3 eye = target + towards;
    const BoundedRay ray{{(eye - scene->center) / scene->units, glm::normalize(-towards), {}, {}}};
    Hit hit;
    trace_closest(*scene, {&ray, 1}, {&hit, 1});
    const bool is_sheet = hit.is_hit() && scene->bodies[hit.body].body == 1;
    to.wrong += !is_sheet;
    to.also_wrong += is_sheet && !is_lit(*scene, ray.ray, hit, glm::normalize(to_light));
    const auto floor_at = float_slabs(eye, -towards, floor), sheet_at = float_slabs(eye, -towards, sheet);
    to.naive_wrong += !(floor_at && sheet_at && sheet_at->near < floor_at->near);
  };
  const Tally tally = tally_shots(context.pool, context.is_quick ? 50'000 : 500'000, 9, shoot);
  const std::string what = "rays that do not see the sheet";
  return {{at_most(0, what, tally.wrong), at_most(0, "places of the sheet that are shaded", tally.also_wrong)},
          {at_most(0, what, tally.naive_wrong)}};
}

// One unit over the floor of a room of 2e15: below is 1, and the floor in any direction d is met at 1 / -d.y.
Outcome huge_room(const Context& context) {
  constexpr double kWall = 1e15;
  const BoxShape room{Vec3(-kWall), Vec3(kWall)};
  const Vec3 eye(1234.5, 1.0 - kWall, -987.0);
  const RayScene scene(scene_of_shapes({room}), context.pool);
  const auto shoot = [&](Random& random, Tally& to) {
    Vec3 down = random.direction();
    down.y = -std::abs(down.y) - 1e-6;
    down = glm::normalize(down);
    const RayScene::Hit hit = scene.nearest(eye, down);
    note(to.worst, hit.is_hit ? std::abs(hit.t * -down.y - 1.0) : 1.0);
    const auto slabs = float_slabs(eye, down, room);
    note(to.naive_worst, slabs ? std::abs(static_cast<double>(slabs->far) * -down.y - 1.0) : 1.0);
  };
  const Tally tally = tally_shots(context.pool, context.is_quick ? 50'000 : 1'000'000, 8, shoot);
  const std::string what = "t of the floor, relative error";
  return {{at_most(1e-6, what, tally.worst)}, {at_most(1e-6, what, tally.naive_worst)}};
}

}  // namespace tilelight::check
