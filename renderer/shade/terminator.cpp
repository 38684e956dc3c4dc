// SPDX-License-Identifier: Apache-2.0
#include "renderer/shade/terminator.h"

#include <algorithm>
#include <cmath>

#include "renderer/shade/surface.h"

namespace tilelight {
namespace {

// Whether two triangles have a place and the normal there in common: they are facets of one curve.
bool share_corner(const CompiledMesh& mesh, uint32_t a, uint32_t b) {
  const auto place = [&](uint32_t prim, size_t v) { return mesh.positions[mesh.triangles[prim][v]]; };
  const auto normal = [&](uint32_t prim, size_t v) { return mesh.normals[mesh.corner_normals[prim][v]]; };
  for (size_t v = 0; v < 3; ++v) {
    for (size_t w = 0; w < 3; ++w)
      if (place(a, v) == place(b, w) && normal(a, v) == normal(b, w)) return true;
  }
  return false;
}

}  // namespace

double reach_of_facets(const CompiledScene& scene, const Departure& facet, const Vec3& geometric_normal,
                       const Vec3& to_light) {
  const CompiledBody& body = scene.bodies[facet.body];
  const CompiledMesh& mesh = *body.mesh;
  // A neighbour is turned from the normals that it shares about as far as this facet is.
  double turn = 0.0, edge = 0.0;
  for (size_t v = 0; v < 3; ++v) {
    Vec3 n = unit_of(body.world_from_normal * mesh.normals[mesh.corner_normals[facet.prim][v]]);
    if (glm::dot(n, geometric_normal) < 0.0) n = -n;
    turn = std::max(turn, glm::length(n - geometric_normal));
    const Vec3 &a = mesh.positions[mesh.triangles[facet.prim][v]],
               &b = mesh.positions[mesh.triangles[facet.prim][(v + 1) % 3]];
    edge = std::max(edge, glm::length(transform_vector(body.world_from_local, b - a)));
  }
  return glm::dot(geometric_normal, to_light) < 2.0 * turn ? 2.0 * edge : 0.0;
}

bool is_lit_from_behind(const CompiledScene& scene, const Ray& shadow, const Vec3& geometric_normal, const Hit& met) {
  if (!met.is_hit() || met.body != shadow.left.body) return false;
  if (!share_corner(*scene.bodies[met.body].mesh, shadow.left.prim, met.prim)) return false;
  const Surface facet = make_surface(scene, shadow, met);
  return glm::dot(facet.normal, shadow.direction) > 0.0 && glm::dot(facet.geometric_normal, geometric_normal) > 0.0;
}

}  // namespace tilelight
