// SPDX-License-Identifier: Apache-2.0
// B: boxes met on their faces and edges, flat, huge, from inside.
#include "renderer/check/rows/boxes.h"

#include <cmath>
#include <set>
#include <string>

#include "renderer/check/kit/naive.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/kit/shots.h"
#include "renderer/scene/transform.h"
#include "renderer/shade/surface.h"
#include "renderer/trace/trace_rays.h"

namespace tilelight::check {
namespace {

Vec3 between(const Vec3& low, const Vec3& high, Random& random) {
  return {random.between(low.x, high.x), random.between(low.y, high.y), random.between(low.z, high.z)};
}

bool meets(const Vec3& origin, const Vec3& direction, const BoxShape& box, bool touching = true) {
  return naive::slabs({Vec3f(origin), Vec3f(direction)}, Vec3f(box.min), Vec3f(box.max), touching).has_value();
}

// A ray in the plane of a face, towards a point of the closed face; every tenth along one of its axes.
RayScene::Aim aim_in_face(const BoxShape& box, Random& random) {
  const auto axis = static_cast<int>(random.next() % 3), along = (axis + 1 + static_cast<int>(random.next() % 2)) % 3;
  const Vec3 size = box.max - box.min;
  Vec3 origin = between(box.min - size, box.max + size, random), target = between(box.min, box.max, random);
  origin[axis] = target[axis] = random.next() % 2 ? box.min[axis] : box.max[axis];
  if (random.next() % 10 == 0) origin[along] = target[along];
  Vec3 direction = target - origin;
  for (int k = 0; k < 3; ++k)
    if (direction[k] == 0.0) direction[k] = random.next() % 2 ? 0.0 : -0.0;
  return {origin, direction};
}

// A box in decimal places, as far from the origin as its size or a thousand times as far.
BoxShape random_box(Random& random) {
  const double place = random.next() % 2 ? 1.0 : 1000.0;
  const Vec3 lower = between(Vec3(-place), Vec3(place), random);
  return {lower, lower + between(Vec3(0.1), Vec3(2.0), random)};
}

// The closed box: what runs in the plane of a face meets it, and what runs away from it does not. Every other scene
// holds a second box far aside, so that the middle of neither is that of the scene.
Outcome in_face_planes(const Context& context) {
  Random boxes(1);
  Tally sum;
  constexpr int kBoxes = 100;
  for (int i = 0; i < kBoxes; ++i) {
    const BoxShape box = i == 0 ? BoxShape{{-1.0, -0.75, -0.5}, {1.0, 0.75, 0.5}} : random_box(boxes);
    const BoxShape aside{box.min - 5.1, box.min - 5.0};
    const RayScene scene(i % 2 ? scene_of_shapes({box}) : scene_of_shapes({box, aside}), context.pool);
    const auto shoot = [&](Random& random, Tally& to) {
      const RayScene::Aim aim = aim_in_face(box, random);
      to.wrong += !scene.nearest(aim.origin, aim.direction).is_hit;
      to.naive_wrong += !meets(aim.origin, aim.direction, box);
      const bool starts_outside =
          glm::any(glm::lessThan(aim.origin, box.min)) || glm::any(glm::greaterThan(aim.origin, box.max));
      to.also_wrong += starts_outside && scene.nearest(aim.origin, -aim.direction).is_hit;
    };
    sum += tally_shots(context.pool, (context.is_quick ? 100'000 : 2'000'000) / kBoxes, 100 + i, shoot);
  }
  return {{at_most(0, "false misses", sum.wrong), at_most(0, "false hits of rays that run away", sum.also_wrong)},
          {at_most(0, "false misses", sum.naive_wrong)}};
}

// Every edge from every side, from near and far, every other ray nearly along a face: an edge belongs to its box, and
// behind a silhouette's edge there is nothing that could hide a miss.
Outcome at_edges(const Context& context) {
  Random boxes(2);
  Tally sum;
  constexpr int kBoxes = 100;
  for (int i = 0; i < kBoxes; ++i) {
    const BoxShape box = random_box(boxes), aside{box.min - 5.1, box.min - 5.0};
    const RayScene scene(i % 2 ? scene_of_shapes({box}) : scene_of_shapes({box, aside}), context.pool);
    const auto shoot = [&](Random& random, Tally& to) {
      const auto axis = static_cast<int>(random.next() % 3);
      Vec3 target = between(box.min, box.max, random), direction = random.direction();
      for (int k = 0; k < 3; ++k)
        if (k != axis) target[k] = random.next() % 2 ? box.min[k] : box.max[k];
      constexpr double kSlopes[] = {1.0, 1.0, 1e-3, 1e-6};
      direction[(axis + 1) % 3] *= kSlopes[random.next() % 4];
      const Vec3 origin = target - random.between(1.0, 4.0) * (random.next() % 2 ? 1.0 : 250.0) * direction;
      to.wrong += !scene.nearest(origin, target - origin).is_hit;
      to.naive_wrong += !meets(origin, target - origin, box);
    };
    sum += tally_shots(context.pool, (context.is_quick ? 100'000 : 2'000'000) / kBoxes, 200 + i, shoot);
  }
  return {{at_most(0, "false misses", sum.wrong)}, {at_most(0, "false misses", sum.naive_wrong)}};
}

// Rays at a slab, from both sides, at points that are not within a thousandth of its rim.
struct SlabCounts {
  int64_t misses = 0, wrong_faces = 0, seen_twice = 0, naive_misses = 0;
};
SlabCounts slab_counts(const BoxShape& box, const Mat3& turn, const Context& context) {
  Scene scene_values = scene_of_shapes({box});
  scene_values.objects[0].world_from_shape = Mat4(turn);
  const RayScene scene(scene_values, context.pool);
  const bool is_flat = box.min.y == box.max.y;
  SlabCounts counts;
  Random random(3);
  for (int i = 0; i < (context.is_quick ? 20'000 : 300'000); ++i) {
    const bool from_above = random.next() % 2;
    Vec3 target = 0.999 * between(box.min, box.max, random), direction = random.direction();
    target.y = from_above ? box.max.y : box.min.y;
    direction.y = from_above ? -std::abs(direction.y) - 0.01 : std::abs(direction.y) + 0.01;
    const Vec3 origin = target - 0.2 * box.max.x * direction;
    const BoundedRay ray{
        {(turn * origin - scene.compiled().center) / scene.compiled().units, glm::normalize(turn * direction), {}, {}}};
    Hit hit, behind;
    trace_closest(scene.compiled(), {&ray, 1}, {&hit, 1});
    counts.misses += !hit.is_hit();
    counts.naive_misses += !meets(origin, direction, box, false);
    if (!hit.is_hit()) continue;
    counts.wrong_faces += !is_flat && hit.prim != (from_above ? 3u : 2u);
    // On from there: through a slab to its other side, from a sheet to nothing.
    const BoundedRay on{{make_surface(scene.compiled(), ray.ray, hit).position,
                         ray.ray.direction,
                         {hit.body, hit.prim},
                         Coincident::after}};
    trace_closest(scene.compiled(), {&on, 1}, {&behind, 1});
    if (is_flat) counts.seen_twice += behind.is_hit();
    if (!is_flat) counts.misses += !behind.is_hit();
  }
  return counts;
}

Outcome flat_boxes(const Context& context) {
  const Mat3 upright(1.0), turned = rotation_about({1, 2, 3}, 37.0);
  const BoxShape sheet{{-1, 0, -1}, {1, 0, 1}}, slab{{-5e5, -5e-7, -5e5}, {5e5, 5e-7, 5e5}};
  Outcome outcome;
  const auto measure = [&](const std::string& name, const BoxShape& box, const Mat3& turn) {
    const SlabCounts counts = slab_counts(box, turn, context);
    outcome.ours.push_back(at_most(0, name + ": misses", static_cast<double>(counts.misses)));
    outcome.ours.push_back(at_most(0, name + ": other faces than aimed at, or one seen twice",
                                   static_cast<double>(counts.wrong_faces + counts.seen_twice)));
    outcome.naive.push_back(at_most(0, name + ": misses", static_cast<double>(counts.naive_misses)));
  };
  measure("thickness 0", sheet, upright);
  measure("thickness 0, turned", sheet, turned);
  measure("1e6 x 1e6 x 1e-6", slab, upright);
  measure("1e6 x 1e6 x 1e-6, turned", slab, turned);
  return outcome;
}

// A room with the eye at `eye` and a lamp at `lamp`, of a wall that has another value in each channel.
ParsedScene room(const std::string& eye, const std::string& target, const std::string& lights) {
  return scene_of(R"({"image": {"width": 160, "height": 120}, "ambient": [0.12, 0.2, 0.3],
    "camera": {"position": )" +
                  eye + R"(, "target": )" + target + R"(, "fov_y_deg": 110}, "lights": [)" + lights + R"(],
    "objects": [{"type": "box", "min": [-1.1, -0.7, -1.3], "max": [0.9, 1.2, 1.7],
                 "material": {"ambient": [0.9, 0.7, 0.3], "diffuse": 0.8, "specular": 0.5}}]})");
}

// The pixels that show the box in another colour than ka Ia, to the last bit; all that show it where `of` is given.
int64_t pixels_not_ambient(const ParsedScene& parsed, TilePool& pool, int64_t* of = nullptr) {
  const Picture picture = picture_of(parsed, pool);
  const Color ambient = parsed.scene.ambient * Color(0.9, 0.7, 0.3);
  int64_t count = 0;
  for (size_t i = 0; i < picture.ids.size(); ++i) {
    if (picture.ids[i] == kNothingHit) continue;
    if (of) ++*of;
    bool is_ambient = true;
    for (int c = 0; c < 3; ++c)
      is_ambient &= picture.linear[3 * i + static_cast<size_t>(c)] == static_cast<float>(ambient[c]);
    count += !is_ambient;
  }
  return count;
}

Outcome inside(const Context& context) {
  const std::string within = R"({"type": "point", "position": [0.3, 0.2, -0.4], "intensity": 5})";
  const std::string without = R"({"type": "point", "position": [3, 4, 2], "intensity": 5},
    {"type": "point", "position": [-1.2, 0, 0], "intensity": 5}, {"type": "directional", "direction": [1, -2, -1]})";
  const ParsedScene dark = room("[0.2, 0.1, 0.3]", "[0, 0, -1]", without);
  const BoxShape& box = std::get<BoxShape>(dark.scene.objects[0].shape);
  const RayScene scene(dark.scene, context.pool);

  int64_t misses = 0, naive_misses = 0;
  std::set<uint64_t> faces;
  Random random(4);
  for (int i = 0; i < (context.is_quick ? 20'000 : 500'000); ++i) {
    const Vec3 origin = between(box.min, box.max, random), direction = random.direction();
    const RayScene::Hit hit = scene.nearest(origin, direction);
    misses += !hit.is_hit;
    faces.insert(hit.id);
    // A box that is met where its slabs are entered, and nowhere else.
    const auto slabs = naive::slabs({Vec3f(origin), Vec3f(direction)}, Vec3f(box.min), Vec3f(box.max), true);
    naive_misses += !(slabs && slabs->near > 0.0f);
  }
  int64_t lit = 0, pixels = 0;
  for (const char* target : {"[0, 0.3, -1]", "[0.3, -0.1, 9]"})
    lit += pixels_not_ambient(room("[0.2, 0.1, 0.3]", target, within), context.pool, &pixels);
  return {{at_most(0, "rays from inside that miss", static_cast<double>(misses)),
           at_least(6, "faces seen from inside", static_cast<double>(faces.size())),
           at_most(0, "lamps outside: pixels inside that are not ka Ia",
                   static_cast<double>(pixels_not_ambient(dark, context.pool))),
           at_most(0, "lamp inside: pixels outside that are not ka Ia",
                   static_cast<double>(pixels_not_ambient(room("[3, 2, 4]", "[0, 0, 0]", within), context.pool))),
           at_most(0, "lamp inside: pixels inside that it does not light", static_cast<double>(pixels - lit))},
          {at_most(0, "rays from inside that miss", static_cast<double>(naive_misses))}};
}

constexpr Row kRows[] = {
    {"B1", "rays in the planes of faces", "origin on the plane, d = +0 and -0", "slabs by min and max", in_face_planes},
    {"B2", "rays at the edges of a box", "all edges, silhouettes too", "slabs without a margin, in float", at_edges},
    {"B3", "flat boxes", "thickness 0; 1e6 x 1e6 x 1e-6", "slabs with near < far", flat_boxes},
    {"B4", "eye or lamp in a box", "from inside; light from the other side", "the entry alone", inside},
    {"B5", "rays at the corners of a box", "along diagonals; touching the corner alone", "slabs with near < far",
     corner},
    {"B6", "seam of two boxes", "rays in the seam itself, decimal places", "slabs by min and max", seams_of_boxes},
    {"B7", "tiny box on a large one", "edge 1e-12 on a cube of 1", "slabs in float", tiny_box},
    {"B8", "huge room", "faces at +-1e15, eye 1 above the floor", "slabs in float", huge_room},
    {"B9", "sheet on a floor", "5e-14 above a floor of 2", "slabs in float", sheet_on_floor},
};

}  // namespace

std::span<const Row> box_rows() { return kRows; }

}  // namespace tilelight::check
