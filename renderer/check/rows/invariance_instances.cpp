// SPDX-License-Identifier: Apache-2.0
// I: stretched, sheared, flattened and chained instances.
#include <cmath>
#include <string>

#include "renderer/base/elementary.h"
#include "renderer/check/kit/rays.h"
#include "renderer/check/rows/invariance_scene.h"

namespace tilelight::check {
namespace {

// A linear map and the inverse of its transpose, which normals take, both written down and not computed.
struct Stretch {
  const char* name;
  Mat3 m, normal_m;  // column-major
  double thinnest;   // the least length that a unit vector may get
};

// A unit sphere (0) and an octahedron (1) under the stretch.
Scene stretched_scene(int body, const Mat3& m) {
  Scene scene = scene_of(R"({
    "meshes": {"octahedron": {"positions": [1,0,0, -1,0,0, 0,1,0, 0,-1,0, 0,0,1, 0,0,-1],
      "indices": [0,2,4, 2,1,4, 1,3,4, 3,0,4, 2,0,5, 1,2,5, 3,1,5, 0,3,5]}},
    "objects": [{"type": "sphere"}, {"type": "mesh", "mesh": "octahedron"}]})")
                    .scene;
  scene.objects = {scene.objects[static_cast<size_t>(body)]};
  scene.objects[0].world_from_shape = Mat4(m);
  return scene;
}

struct Spot {
  Vec3 place, normal;  // before the stretch
};
Spot random_spot(int body, Random& random) {
  const Vec3 on_ball = random.direction();
  if (body == 0) return {on_ball, on_ball};
  const Vec3 size = glm::abs(on_ball);  // inside a face of the octahedron
  return {on_ball / (size.x + size.y + size.z), glm::sign(on_ball)};
}

// Rays at points that are known, from so near that the rounding of their start says nothing.
void measure_normals(const Context& context, const Stretch& stretch, Outcome& out) {
  const int count = context.is_quick ? 2'000 : 50'000;
  double worst = 0.0, worst_reference = 0.0, worst_textbook = 0.0;
  int64_t misses = 0;
  Random random(6);
  for (const int body : {0, 1}) {
    const Scene scene = stretched_scene(body, stretch.m);
    const RayScene rays(scene, context.pool);
    const ReferenceScene reference(scene);
    for (int i = 0; i < count; ++i) {
      const Spot spot = random_spot(body, random);
      const Vec3 place = stretch.m * spot.place, normal = glm::normalize(stretch.normal_m * spot.normal);
      const Vec3 side = random.direction();
      const Vec3 direction = glm::normalize(0.7 * (side - glm::dot(side, normal) * normal) - normal);
      const Vec3 origin = place - 3.0 * stretch.thinnest * direction;
      const RayScene::Hit hit = rays.nearest(origin, direction);
      misses += !hit.is_hit;
      if (!hit.is_hit) continue;
      note(worst, angle_between(hit.normal, normal));
      const auto plain = reference.nearest({.origin = origin, .direction = direction});
      if (plain)
        note(worst_reference, angle_between(hit.normal, reference::geometric_normal(reference.body(0), *plain)));
      note(worst_textbook, angle_between(glm::normalize(stretch.m * spot.normal), normal));
    }
  }
  const std::string of = std::string(" under ") + stretch.name;
  out.ours.push_back(at_most(0, "rays that miss" + of, static_cast<double>(misses)));
  out.ours.push_back(at_most(1e-5, "normals off the closed form" + of + ", rad", worst));
  out.ours.push_back(at_most(1e-5, "normals off those of the reference" + of + ", rad", worst_reference));
  out.naive.push_back(at_most(1e-5, "normals off the closed form" + of + ", rad", worst_textbook));
}

Outcome anisotropic(const Context& context) {
  Outcome out;
  const Mat3 needle(1, 0, 0, 0, 1, 0, 0, 0, 1e6), needle_normals(1, 0, 0, 0, 1, 0, 0, 0, 1e-6);
  const Mat3 disc(1, 0, 0, 0, 1e-6, 0, 0, 0, 1), disc_normals(1, 0, 0, 0, 1e6, 0, 0, 0, 1);
  measure_normals(context, {"(1, 1, 1e6)", needle, needle_normals, 1.0}, out);
  measure_normals(context, {"(1, 1e-6, 1)", disc, disc_normals, 1e-6}, out);
  return out;
}

Outcome sheared(const Context& context) {
  Outcome out;
  const Mat3 shear(1, 0, 0, 1e3, 1, 0, 0, 0, 1), shear_normals(1, -1e3, 0, 0, 1, 0, 0, 0, 1);  // x += 1e3 y
  measure_normals(context, {"x += 1e3 y", shear, shear_normals, 1e-3}, out);
  return out;
}

int count_accepted(std::span<const char* const> transforms) {
  int accepted = 0;
  for (const char* transform : transforms) {
    const std::string json = std::string(R"({"objects": [{"type": "sphere", )") + transform + "}]}";
    accepted += parse_scene(json, Limits{}).has_value();
  }
  return accepted;
}

// Rays from both sides at a square that is flat in y, at its very corners too.
Outcome flat(const Context& context) {
  constexpr const char* kSingular[] = {R"("scale": [1, 0, 1])",
                                       R"("scale": 0)",
                                       R"("matrix": [1,0,0,0, 0,0,0,0, 0,0,1,0, 0,0,0,1])",
                                       R"("matrix": [1,2,3,0, 4,5,6,0, 7,8,9,0, 0,0,0,1])",
                                       R"("matrix": [NaN,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1])",
                                       R"("matrix": [1e400,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1])"};
  constexpr const char* kQuad = R"({"camera": {"position": [1, 2, 3]}, "image": {"width": 64, "height": 64},
    "objects": [{"type": "box", "min": [-1, 0, -1], "max": [1, 0, 1]}]})";
  constexpr const char* kDisc = R"({"camera": {"position": [1, 2, 3]}, "image": {"width": 64, "height": 64},
    "objects": [{"type": "sphere", "scale": [1, 1e-15, 1]}]})";
  const int count = context.is_quick ? 10'000 : 200'000;
  int64_t misses = 0, textbook_misses = 0;
  double worst = 0.0;
  const RayScene quad(kQuad, context.pool), disc(kDisc, context.pool);
  const glm::mat4 flattened(1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1), inverse = glm::inverse(flattened);
  Random random(7);
  for (int i = 0; i < count; ++i) {
    const double reach = i % 10 == 0 ? 1.0 : random.unit();
    const double x = i % 10 == 0 ? std::copysign(1.0, random.unit() - 0.5) : random.between(-reach, reach);
    const double z = i % 10 == 0 ? std::copysign(1.0, random.unit() - 0.5) : random.between(-reach, reach);
    const double height = i % 2 ? 1.0 : -1.0;
    const Vec3 origin(x, height, z), down(0.0, -height, 0.0);
    for (const RayScene* scene : {&quad, &disc}) {
      if (scene == &disc && x * x + z * z > 0.999) continue;
      const RayScene::Hit hit = scene->nearest(origin, down);
      misses += !hit.is_hit;
      if (hit.is_hit) note(worst, std::abs(hit.t - 1.0));
    }
    const naive::RayF local{Vec3f(inverse * glm::vec4(Vec3f(origin), 1.0f)), glm::mat3(inverse) * Vec3f(down)};
    textbook_misses += !naive::slabs(local, Vec3f(-1.0f), Vec3f(1.0f), true);
  }
  const Picture quad_picture = picture_of(scene_of(kQuad), context.pool);
  const Picture disc_picture = picture_of(scene_of(kDisc), context.pool);
  return {{at_most(0, "singular or unreadable transforms that are accepted", count_accepted(kSingular)),
           at_most(0, "rays that miss the flat square or the disc", static_cast<double>(misses)),
           at_most(1e-6, "t, off by", worst),
           at_most(0, "samples that are not finite",
                   static_cast<double>(quad_picture.nonfinite() + disc_picture.nonfinite()))},
          {at_most(0, "rays that miss the flattened box", static_cast<double>(textbook_misses))}};
}

constexpr Row kRows[] = {
    {"I6", "stretched instances", "scale (1, 1, 1e6) and (1, 1e-6, 1)", "n' = M n", anisotropic},
    {"I7", "flattened instances", "scale y = 0, singular and NaN matrices, a box with min = max",
     "inverse of a singular matrix", flat},
    {"I9", "sheared instances", "x += 1e3 y", "n' = M n", sheared},
};

}  // namespace

std::span<const Row> instance_rows() { return kRows; }

}  // namespace tilelight::check
