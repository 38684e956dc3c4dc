// SPDX-License-Identifier: Apache-2.0
#include "renderer/shade/surface.h"

#include <algorithm>
#include <cmath>

#include "renderer/base/safe_length.h"

namespace tilelight {
namespace {

// The hit in the body's local space, reprojected, so that its error is that of the primitive and not of the ray's
// length.
LocalPoint local_point(const CompiledBody& body, const Ray& ray, const Hit& hit) {
  if (body.kind == BodyKind::mesh) return triangle_point(*body.mesh, hit.prim, hit.b0, hit.b1);
  LocalPoint out;
  out.position = transform_point(body.local_from_world, ray.origin) +
                 hit.t * transform_vector(body.local_from_world, ray.direction);
  switch (body.kind) {
    case BodyKind::sphere:
      out.position = glm::normalize(out.position);
      out.geometric = out.position;
      break;
    case BodyKind::box: {
      const int axis = static_cast<int>(hit.prim / 2);
      const double side = hit.prim % 2 ? 1.0 : -1.0;
      out.position[axis] = side * body.half[axis];
      out.geometric[axis] = side;
      break;
    }
    case BodyKind::plane:
      out.position.y = 0.0;
      out.geometric.y = 1.0;
      break;
    case BodyKind::mesh:
      break;
  }
  return out;
}

// Cells of a checker: on curved spheres in three dimensions, else on the two axes other than the dominant one of the
// geometric normal, all in the pattern frame.
Color checker_color(const Checker& checker, const CompiledBody& body, const LocalPoint& p) {
  const Vec3 place = transform_point(body.pattern_from_local, p.position) / checker.size;
  double cells = 0.0;
  int dominant = -1;
  if (!body.has_solid_pattern) {
    // The pattern frame differs from the local one by a uniform scale and a shift, so normals keep their direction.
    // Of axes that rounding cannot tell apart (facets at 45 degrees) the first counts.
    const Vec3 n = glm::abs(p.geometric);
    const double nearly = (1.0 - 0x1p-20) * std::max({n.x, n.y, n.z});
    dominant = n.x >= nearly ? 0 : n.y >= nearly ? 1 : 2;
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (axis != dominant) cells += std::floor(place[axis]);
  }
  return cells - 2.0 * std::floor(0.5 * cells) == 0.0 ? checker.a : checker.b;
}

Color paint_color(const Paint& paint, const CompiledBody& body, const LocalPoint& p) {
  if (const auto* color = std::get_if<Color>(&paint)) return *color;
  return checker_color(std::get<Checker>(paint), body, p);
}

}  // namespace

LocalPoint triangle_point(const CompiledMesh& mesh, uint32_t prim, double b0, double b1) {
  const auto& tri = mesh.triangles[prim];
  const Vec3 &a = mesh.positions[tri[0]], &b = mesh.positions[tri[1]], &c = mesh.positions[tri[2]];
  const double b2 = 1.0 - b0 - b1;
  LocalPoint out;
  out.position = b0 * a + b1 * b + b2 * c;
  out.geometric = cross_of(b - a, c - a);
  if (!mesh.corner_normals.empty()) {
    const auto& n = mesh.corner_normals[prim];
    out.shading = b0 * mesh.normals[n[0]] + b1 * mesh.normals[n[1]] + b2 * mesh.normals[n[2]];
    out.is_smooth = out.shading != Vec3(0.0);  // opposite normals cancel
  }
  return out;
}

void turn_to(Surface& surface, const Vec3& looking) {
  if (!(glm::dot(surface.geometric_normal, looking) < 0.0)) {
    surface.geometric_normal = -surface.geometric_normal;
    surface.from_outside = !surface.from_outside;
  }
  if (glm::dot(surface.normal, surface.geometric_normal) < 0.0) surface.normal = -surface.normal;
}

Surface make_surface(const CompiledScene& scene, const Ray& ray, const Hit& hit) {
  return make_surface_at(scene, ray, hit, local_point(scene.bodies[hit.body], ray, hit));
}

Surface make_surface_at(const CompiledScene& scene, const Ray& ray, const Hit& hit, const LocalPoint& local) {
  const CompiledBody& body = scene.bodies[hit.body];
  Surface out;
  out.body = &body;
  out.material = &scene.materials[body.material];
  out.here = {hit.body, hit.prim};
  out.position = transform_point(body.world_from_local, local.position);
  out.geometric_normal = unit_of(body.world_from_normal * local.geometric);
  out.normal = local.is_smooth ? unit_of(body.world_from_normal * local.shading) : out.geometric_normal;
  out.is_rounded = body.kind == BodyKind::mesh && !body.mesh->corner_normals.empty();
  turn_to(out, ray.direction);
  out.ambient = paint_color(out.material->source.ambient, body, local);
  out.diffuse = paint_color(out.material->source.diffuse, body, local);
  return out;
}

Vec3 rounded_position(const Surface& surface, const Hit& hit) {
  const CompiledBody& body = *surface.body;
  const CompiledMesh& mesh = *body.mesh;
  const auto &corner = mesh.triangles[hit.prim], &normal = mesh.corner_normals[hit.prim];
  const double weight[3] = {hit.b0, hit.b1, 1.0 - hit.b0 - hit.b1};
  Vec3 facet(0.0), lift(0.0);
  for (int i = 0; i < 3; ++i) facet += weight[i] * mesh.positions[corner[i]];
  Vec3 up = cross_of(mesh.positions[corner[1]] - mesh.positions[corner[0]],
                     mesh.positions[corner[2]] - mesh.positions[corner[0]]);
  if (!surface.from_outside) up = -up;
  for (int i = 0; i < 3; ++i) {
    Vec3 n = mesh.normals[normal[i]];
    if (glm::dot(n, up) < 0.0) n = -n;  // given against the winding, or seen from inside
    const double under = glm::dot(mesh.positions[corner[i]] - facet, n);  // the tangent plane at the corner
    if (under > 0.0) lift += weight[i] * under * n;
  }
  return surface.position + transform_vector(body.world_from_local, lift);
}

}  // namespace tilelight
