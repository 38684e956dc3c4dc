// SPDX-License-Identifier: Apache-2.0
#include "renderer/check/kit/rays.h"

#include "renderer/base/elementary.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/shade/surface.h"
#include "renderer/trace/trace_rays.h"

namespace tilelight::check {

RayScene::RayScene(std::string_view json, TilePool& pool) : RayScene(scene_of(json).scene, pool) {}
RayScene::RayScene(const Scene& scene, TilePool& pool) : scene_(compile_scene(scene, pool)) {}

std::vector<RayScene::Hit> RayScene::nearest(std::span<const Aim> rays) const {
  std::vector<BoundedRay> bounded;
  bounded.reserve(rays.size());
  for (const Aim& aim : rays)
    bounded.push_back({{(aim.origin - scene_->center) / scene_->units, glm::normalize(aim.direction), {}, {}}});
  std::vector<tilelight::Hit> found(rays.size());
  trace_closest(*scene_, bounded, found);

  std::vector<Hit> hits(rays.size());
  for (size_t i = 0; i < rays.size(); ++i) {
    if (!found[i].is_hit()) continue;
    const uint64_t body = scene_->bodies[found[i].body].body;
    hits[i] = {true, found[i].t * scene_->units, body << 32 | found[i].prim,
               make_surface(*scene_, bounded[i].ray, found[i]).geometric_normal};
  }
  return hits;
}

RayScene::Hit RayScene::nearest(const Vec3& origin, const Vec3& direction) const {
  const Aim aim{origin, direction};
  return nearest({&aim, 1})[0];
}

double angle_between(const Vec3& a, const Vec3& b) {
  return 2.0 * elementary::atan2(glm::length(a - b), glm::length(a + b));
}

uint64_t Random::next() {
  uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

Vec3 Random::direction() {
  while (true) {  // a point of the cube that lies in the ball and not at its centre
    const Vec3 p(between(-1.0, 1.0), between(-1.0, 1.0), between(-1.0, 1.0));
    const double length = glm::length(p);
    if (length <= 1.0 && length > 1e-3) return p / length;
  }
}

}  // namespace tilelight::check
