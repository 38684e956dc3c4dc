// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include "renderer/trace/intersect.h"
#include "renderer/trace/tile_job.h"

namespace tilelight {
namespace {

// Inside or outside by the sign of Ng.d at the nearest triangle along a direction; every triangle is tried, since this is
// asked once a view.
bool is_inside_mesh(const CompiledMesh& mesh, const Vec3& point) {
  const Vec3 direction(0.5773, 0.5791, 0.5756);  // generic: along no axis or diagonal of a modelled shape
  const Shear shear(direction);
  double nearest = std::numeric_limits<double>::infinity();
  bool inside = false;
  for (const auto& tri : mesh.triangles) {
    const Vec3 &a = mesh.positions[tri[0]], &b = mesh.positions[tri[1]], &c = mesh.positions[tri[2]];
    TriangleHit hit;
    if (!intersect_triangle(a, b, c, point, shear, hit) || !(hit.t > 0.0) || !(hit.t < nearest)) continue;
    nearest = hit.t;
    inside = glm::dot(glm::cross(b - a, c - a), direction) > 0.0;
  }
  return inside;
}

bool is_inside(const CompiledBody& body, const Vec3& point) {
  const Vec3 p = transform_point(body.local_from_world, point);
  switch (body.kind) {
    case BodyKind::sphere: return glm::dot(p, p) < 1.0;
    case BodyKind::box: return std::abs(p.x) < body.half.x && std::abs(p.y) < body.half.y && std::abs(p.z) < body.half.z;
    case BodyKind::mesh: return is_inside_mesh(*body.mesh, p);
    case BodyKind::plane: return false;
  }
  return false;
}

}  // namespace

MediaSet media_at_eye(const CompiledScene& scene, const ViewPlan& plan) {
  MediaSet media;
  if (!plan.features.has(Feature::transmission)) return media;
  for (uint32_t i = 0; i < scene.finite_bodies; ++i) {
    const CompiledBody& body = scene.bodies[i];
    if (body.closed && scene.materials[body.material].is_transmissive && is_inside(body, plan.eye.origin)) media.enter(i);
  }
  return media;
}

}  // namespace tilelight
