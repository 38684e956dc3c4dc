// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "renderer/trace/intersect.h"
#include "renderer/trace/tile_job.h"

namespace tilelight {
namespace {

constexpr auto kAhead = [](double t, uint32_t) { return t > 0.0; };

// Inside or outside by the sign of Ng.d at the nearest triangle along the ray; every triangle is tried, since this is
// asked once a view.
std::optional<double> mesh_exit(const CompiledMesh& mesh, const LocalRay& ray) {
  const Shear shear(ray.direction);
  double nearest = std::numeric_limits<double>::infinity();
  bool inside = false;
  for (const auto& tri : mesh.triangles) {
    const Vec3 &a = mesh.positions[tri[0]], &b = mesh.positions[tri[1]], &c = mesh.positions[tri[2]];
    TriangleHit hit;
    if (!intersect_triangle(a, b, c, ray.origin, shear, hit) || !(hit.t > 0.0) || !(hit.t < nearest)) continue;
    nearest = hit.t;
    inside = glm::dot(glm::cross(b - a, c - a), ray.direction) > 0.0;
  }
  return inside ? std::optional(nearest) : std::nullopt;
}

// How far it is along the ray to the surface of the body; none if the ray starts outside.
std::optional<double> exit_distance(const CompiledBody& body, const Ray& world_ray) {
  const LocalRay ray = to_local(body, world_ray);
  const Vec3 p = glm::abs(ray.origin);
  double t = 0.0;
  uint32_t face = 0;
  switch (body.kind) {
    case BodyKind::sphere:
      if (!(glm::dot(p, p) < 1.0) || !intersect_sphere(ray, false, kAhead, t)) return std::nullopt;
      return t;
    case BodyKind::box:
      if (!(p.x < body.half.x && p.y < body.half.y && p.z < body.half.z)) return std::nullopt;
      return intersect_box(body.half, ray, kNone, kAhead, t, face) ? std::optional(t) : std::nullopt;
    case BodyKind::mesh:
      return mesh_exit(*body.mesh, ray);
    case BodyKind::plane:
      break;
  }
  return std::nullopt;
}

}  // namespace

std::vector<uint32_t> media_at_eye(const CompiledScene& scene, const ViewPlan& plan) {
  // Along no axis or diagonal of a modelled shape.
  const Ray ray{plan.eye.origin, glm::normalize(Vec3(0.31415, 0.59265, 0.35897)), {}};
  std::vector<std::pair<double, uint32_t>> around;  // by distance, the farthest first: the order of entering
  for (uint32_t i = 0; i < scene.finite_bodies; ++i) {
    const CompiledBody& body = scene.bodies[i];
    if (!body.closed || !scene.materials[body.material].is_transmissive) continue;
    if (const auto exit = exit_distance(body, ray)) around.emplace_back(-*exit, i);
  }
  std::sort(around.begin(), around.end());
  std::vector<uint32_t> media;
  for (const auto& [order, body] : around) media.push_back(body);
  return media;
}

}  // namespace tilelight
