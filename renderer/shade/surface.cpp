// SPDX-License-Identifier: Apache-2.0
#include "renderer/shade/surface.h"

#include <algorithm>
#include <cmath>

#include "renderer/shade/surface-inl.h"

namespace tilelight {

using namespace HWY_NAMESPACE;

namespace {

TriangleOf<double> triangle_of(const CompiledMesh& mesh, uint32_t prim) {
  TriangleOf<double> out = {};
  for (int v = 0; v < 3; ++v) {
    out.corner[v] = of<double>(mesh.positions[mesh.triangles[prim][v]]);
    if (is_smooth(mesh)) out.normal[v] = of<double>(mesh.normals[mesh.corner_normals[prim][v]]);
  }
  return out;
}

LocalPoint point_of(const LocalPointOf<double>& p) {
  return {vec_of(p.position), vec_of(p.geometric), vec_of(p.shading), p.is_smooth};
}

LocalPoint local_point(const CompiledBody& body, const Ray& ray, const Hit& hit) {
  if (body.kind == BodyKind::mesh) return triangle_point(*body.mesh, hit.prim, hit.b0, hit.b1);
  const double prim = hit.prim;
  return point_of(point_of_solid(body, of<double>(ray.origin), of<double>(ray.direction), hit.t, prim));
}

}  // namespace

LocalPoint triangle_point(const CompiledMesh& mesh, uint32_t prim, double b0, double b1) {
  return point_of(point_of_triangle(triangle_of(mesh, prim), is_smooth(mesh), b0, b1));
}

double facet_cosine(const Surface& surface) {
  const CompiledBody& body = *surface.body;
  if (body.kind != BodyKind::mesh || !is_smooth(*body.mesh)) return 1.0;
  double least = 1.0;
  for (const uint32_t n : body.mesh->corner_normals[surface.here.prim]) {
    const Vec3 normal = unit_of(body.world_from_normal * body.mesh->normals[n]);
    least = std::min(least, std::abs(glm::dot(normal, surface.geometric_normal)));
  }
  return least;
}

Surface make_surface(const CompiledScene& scene, const Ray& ray, const Hit& hit) {
  return make_surface_at(scene, ray, hit, local_point(scene.bodies[hit.body], ray, hit));
}

Surface make_surface_at(const CompiledScene& scene, const Ray& ray, const Hit& hit, const LocalPoint& local) {
  const CompiledBody& body = scene.bodies[hit.body];
  const LocalPointOf<double> point = {of<double>(local.position), of<double>(local.geometric),
                                      of<double>(local.shading), local.is_smooth};
  const auto at = surface_at(scene, body, point, of<double>(ray.direction));
  Surface out;
  out.body = &body;
  out.material = &scene.materials[body.material];
  out.here = {hit.body, hit.prim};
  out.position = vec_of(at.position);
  out.geometric_normal = vec_of(at.geometric_normal);
  out.normal = vec_of(at.normal);
  out.from_outside = at.from_outside;
  out.ambient = vec_of(at.ambient), out.diffuse = vec_of(at.diffuse);
  return out;
}

}  // namespace tilelight
