// SPDX-License-Identifier: Apache-2.0
#include "renderer/measure/reference_bodies.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "renderer/base/elementary.h"

namespace tilelight::reference {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

const std::array<uint32_t, 3>& corners(const TriMesh& mesh, uint32_t triangle) { return mesh.triangles[triangle]; }

int dominant_axis(const Vec3& v) {
  const Vec3 a = glm::abs(v);
  return a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
}

Box world_bounds(const ReferenceBody& body) {
  Box box;
  switch (body.kind) {
    case BodyKind::plane:
      return {Vec3(-kInfinity), Vec3(kInfinity)};
    case BodyKind::mesh:
      for (const Vec3& p : body.mesh->mesh->positions) box.include(body.world_point(p));
      break;
    case BodyKind::sphere:
    case BodyKind::box:
      for (int row = 0; row < 3; ++row) {
        const Vec3 r(body.world_from_local[0][row], body.world_from_local[1][row], body.world_from_local[2][row]);
        const double reach = body.kind == BodyKind::sphere ? glm::length(r) : glm::dot(glm::abs(r), body.half);
        box.lo[row] = body.translation[row] - reach, box.hi[row] = body.translation[row] + reach;
      }
  }
  return box;
}

double largest(const Vec3& v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

// |f + t d|^2 = 1 with the discriminant of Hearn and Baker, which does not cancel for far or for huge spheres (Haines,
// Guenther, Akenine-Moeller, Ray Tracing Gems ch. 7).
struct Roots {
  double near, far;
};
std::optional<Roots> sphere_roots(const Vec3& f, const Vec3& d) {
  const double a = glm::dot(d, d), b = -glm::dot(f, d);
  const Vec3 closest = f + (b / a) * d;
  const double discriminant = 1.0 - glm::dot(closest, closest);
  if (discriminant < 0.0) return std::nullopt;
  const double length = glm::length(f);
  const double c = (length - 1.0) * (length + 1.0);
  const double q = b + std::copysign(std::sqrt(a * discriminant), b);
  const double t0 = q == 0.0 ? 0.0 : c / q, t1 = q / a;
  return Roots{std::min(t0, t1), std::max(t0, t1)};
}

Hit sphere_hit(uint32_t id, double t, const Vec3& origin, const Vec3& direction) {
  return {.t = t, .body = id, .local = glm::normalize(origin + t * direction)};
}

AnalyticHits sphere_hits(uint32_t id, const Ray& ray, const Vec3& o, const Vec3& d) {
  AnalyticHits found;
  if (ray.left.body == id) {  // one root is the start, the other follows from the sum of the roots
    const Vec3& start = ray.left.local;
    const double t = -2.0 * glm::dot(start, d) / glm::dot(d, d);
    if (t > ray.noise) found.hits[found.count++] = sphere_hit(id, t, start, d);
    return found;
  }
  if (const auto roots = sphere_roots(o, d)) {
    found.hits[found.count++] = sphere_hit(id, roots->near, o, d);
    found.hits[found.count++] = sphere_hit(id, roots->far, o, d);
  }
  return found;
}

Hit box_hit(uint32_t id, double t, int axis, double side, const Vec3& half, const Vec3& origin, const Vec3& direction) {
  Hit hit{.t = t,
          .body = id,
          .primitive = static_cast<uint32_t>(2 * axis + (side > 0.0 ? 1 : 0)),
          .local = glm::clamp(origin + t * direction, -half, half)};
  hit.local[axis] = std::copysign(half[axis], side);
  return hit;
}

// Three slabs, each clipped on its own; a ray in the plane of a face meets the closed box.
AnalyticHits box_hits(const ReferenceBody& body, uint32_t id, const Ray& ray, const Vec3& origin, const Vec3& d) {
  const bool leaves_this = ray.left.body == id;
  const Vec3& o = leaves_this ? ray.left.local : origin;
  double near = -kInfinity, far = kInfinity;
  int near_axis = 0, far_axis = 0;
  for (int k = 0; k < 3; ++k) {
    if (d[k] == 0.0) {
      if (std::fabs(o[k]) > body.half[k]) return {};
      continue;
    }
    const double side = std::copysign(body.half[k], d[k]);
    const double enter = (-side - o[k]) / d[k], exit = (side - o[k]) / d[k];
    if (enter > near) near = enter, near_axis = k;
    if (exit < far) far = exit, far_axis = k;
  }
  AnalyticHits found;
  if (near > far) return found;
  if (!leaves_this) found.hits[found.count++] = box_hit(id, near, near_axis, -d[near_axis], body.half, o, d);
  if (!leaves_this || far > ray.noise)
    found.hits[found.count++] = box_hit(id, far, far_axis, d[far_axis], body.half, o, d);
  return found;
}

Hit plane_hit(uint32_t id, double t, const Vec3& o, const Vec3& d) {
  return {.t = t, .body = id, .local = Vec3(o.x + t * d.x, 0.0, o.z + t * d.z)};
}

AnalyticHits plane_hits(uint32_t id, const Ray& ray, const Vec3& o, const Vec3& d) {
  AnalyticHits found;
  if (ray.left.body != id && d.y != 0.0) found.hits[found.count++] = plane_hit(id, -o.y / d.y, o, d);
  return found;
}

Vec3 local_normal(const ReferenceBody& body, const Hit& hit) {
  switch (body.kind) {
    case BodyKind::sphere:
      return hit.local;
    case BodyKind::plane:
      return {0.0, 1.0, 0.0};
    case BodyKind::box: {
      Vec3 n(0.0);
      n[static_cast<int>(hit.primitive / 2)] = hit.primitive % 2 ? 1.0 : -1.0;
      return n;
    }
    case BodyKind::mesh:
      break;
  }
  const TriMesh& mesh = *body.mesh->mesh;
  const auto& [a, b, c] = corners(mesh, hit.primitive);
  const Vec3 ab = mesh.positions[b] - mesh.positions[a], ac = mesh.positions[c] - mesh.positions[a];
  return glm::normalize(glm::cross(ab / largest(ab), ac / largest(ac)));
}

}  // namespace

MeshTree::MeshTree(std::shared_ptr<const TriMesh> m) : mesh(std::move(m)) {
  std::vector<Box> boxes(mesh->triangles.size());
  for (size_t i = 0; i < boxes.size(); ++i)
    for (const uint32_t corner : mesh->triangles[i]) boxes[i].include(mesh->positions[corner]);
  double size = 0.0;
  for (const Vec3& p : mesh->positions) size = std::max(size, largest(p));
  for (Box& box : boxes) box = box.padded(size * kRounding);
  tree = BoxTree(boxes);
}

ReferenceBody::ReferenceBody(const Body& body, std::shared_ptr<const MeshTree> mesh_tree)
    : kind(body.kind),
      world_from_local(body.world_from_local),
      local_from_world(glm::inverse(world_from_local)),
      normal_from_local(glm::transpose(local_from_world)),
      translation(body.world_from_local[3]),
      half(body.half),
      pattern_from_local(body.pattern_from_local),
      pattern_normal_from_local(glm::transpose(glm::inverse(Mat3(body.pattern_from_local)))),
      material(body.material),
      mesh(std::move(mesh_tree)),
      has_inside(body.has_inside),
      may_touch_itself(body.kind == BodyKind::mesh && body.layer == Layer::medium && !body.mesh->is_known_outward),
      layer(body.layer),
      rank(body.rank),
      bounds(world_bounds(*this)),
      extent(kind == BodyKind::plane ? largest(translation) : std::max(largest(bounds.lo), largest(bounds.hi))),
      face_rounding(largest(body.rounding)) {
  bounds = bounds.padded(extent * kRounding);
}

AnalyticHits analytic_hits(const ReferenceBody& body, uint32_t id, const Ray& ray) {
  const Vec3 o = body.local_point(ray.origin), d = body.local_from_world * ray.direction;
  switch (body.kind) {
    case BodyKind::sphere:
      return sphere_hits(id, ray, o, d);
    case BodyKind::box:
      return box_hits(body, id, ray, o, d);
    case BodyKind::plane:
      return plane_hits(id, ray, o, d);
    case BodyKind::mesh:
      break;
  }
  return {};
}

ShearedRay::ShearedRay(const Vec3& local_origin, const Vec3& local_direction)
    : origin(local_origin), direction(local_direction) {
  kz = dominant_axis(direction), kx = (kz + 1) % 3, ky = (kx + 1) % 3;
  if (direction[kz] < 0.0) std::swap(kx, ky);
  sx = direction[kx] / direction[kz], sy = direction[ky] / direction[kz], sz = 1.0 / direction[kz];
}

std::optional<Hit> triangle_hit(const TriMesh& mesh, uint32_t body, uint32_t triangle, const ShearedRay& ray) {
  const auto& [ia, ib, ic] = corners(mesh, triangle);
  const Vec3 a = mesh.positions[ia] - ray.origin, b = mesh.positions[ib] - ray.origin,
             c = mesh.positions[ic] - ray.origin;
  const auto sheared_x = [&](const Vec3& p) { return p[ray.kx] - ray.sx * p[ray.kz]; };
  const auto sheared_y = [&](const Vec3& p) { return p[ray.ky] - ray.sy * p[ray.kz]; };
  const double ax = sheared_x(a), ay = sheared_y(a), bx = sheared_x(b), by = sheared_y(b), cx = sheared_x(c),
               cy = sheared_y(c);
  const double u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
  if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) return std::nullopt;
  const double det = u + v + w;
  if (det == 0.0) return std::nullopt;  // edge-on, or no area
  const Vec3 bary = Vec3(u, v, w) / det;
  const double t = ray.sz * (bary.x * a[ray.kz] + bary.y * b[ray.kz] + bary.z * c[ray.kz]);
  const Vec3 local = bary.x * mesh.positions[ia] + bary.y * mesh.positions[ib] + bary.z * mesh.positions[ic];
  return Hit{.t = t, .body = body, .primitive = triangle, .local = local, .barycentric = bary};
}

Vec3 geometric_normal(const ReferenceBody& body, const Hit& hit) {
  return glm::normalize(body.normal_from_local * local_normal(body, hit));
}

double facet_spread(const ReferenceBody& body, const Hit& hit) {
  if (body.kind != BodyKind::mesh || body.mesh->mesh->corner_normals.empty()) return 0.0;
  const Vec3 facet = geometric_normal(body, hit);
  double spread = 0.0;
  for (const Vec3& corner : body.mesh->mesh->corner_normals[hit.primitive]) {
    const Vec3 n = glm::normalize(body.normal_from_local * corner);
    const double angle = elementary::atan2(glm::length(glm::cross(facet, n)), std::fabs(glm::dot(facet, n)));
    spread = std::max(spread, angle);
  }
  return spread;
}

SurfacePoint surface_at(const ReferenceBody& body, const Hit& hit) {
  const Vec3 n = geometric_normal(body, hit);
  SurfacePoint s{body.world_point(hit.local), n, n};
  if (body.kind == BodyKind::mesh && !body.mesh->mesh->corner_normals.empty()) {
    const auto& normals = body.mesh->mesh->corner_normals[hit.primitive];
    const Vec3 sum = hit.barycentric.x * normals[0] + hit.barycentric.y * normals[1] + hit.barycentric.z * normals[2];
    const Vec3 world = body.normal_from_local * sum;
    if (glm::dot(world, world) > 0.0) s.shading = glm::normalize(world);  // opposite normals cancel: the geometric one
  }
  return s;
}

std::optional<Vec3> lift_to_curve(const ReferenceBody& body, const Hit& hit, bool is_inside) {
  if (body.kind != BodyKind::mesh || body.mesh->mesh->corner_normals.empty()) return std::nullopt;
  const TriMesh& mesh = *body.mesh->mesh;
  const auto& vertices = corners(mesh, hit.primitive);
  const auto& normals = mesh.corner_normals[hit.primitive];
  const Vec3 facing = (is_inside ? -1.0 : 1.0) * local_normal(body, hit);
  Vec3 mixed(0.0);
  for (int i = 0; i < 3; ++i) {
    const Vec3 off = hit.local - mesh.positions[vertices[i]];
    const Vec3 normal = glm::dot(normals[i], facing) < 0.0 ? -normals[i] : normals[i];
    const double height = glm::dot(off, normal);  // of the facet over the plane
    const Vec3 projected = off - std::min(0.0, height) * normal;
    mixed += hit.barycentric[i] * (projected - off);
  }
  return body.world_from_local * mixed;
}

RoundedFacet rounded_facet(const ReferenceBody& body, const Hit& hit) {
  const TriMesh& mesh = *body.mesh->mesh;
  const auto& vertices = corners(mesh, hit.primitive);
  const Vec3 facing = geometric_normal(body, hit);
  RoundedFacet out;
  for (int i = 0; i < 3; ++i) {
    const Vec3 normal = glm::normalize(body.normal_from_local * mesh.corner_normals[hit.primitive][i]);
    out.turn = std::max(out.turn, std::min(glm::length(normal - facing), glm::length(normal + facing)));
    const Vec3 edge = mesh.positions[vertices[(i + 1) % 3]] - mesh.positions[vertices[i]];
    out.longest_edge = std::max(out.longest_edge, glm::length(body.world_from_local * edge));
  }
  return out;
}

bool are_of_one_curve(const ReferenceBody& body, const Hit& one, const Hit& other) {
  const TriMesh& mesh = *body.mesh->mesh;
  for (int i = 0; i < 9; ++i) {
    const int a = i / 3, b = i % 3;
    const bool is_one_place =
        mesh.positions[corners(mesh, one.primitive)[a]] == mesh.positions[corners(mesh, other.primitive)[b]];
    if (is_one_place && mesh.corner_normals[one.primitive][a] == mesh.corner_normals[other.primitive][b]) return true;
  }
  return false;
}

PatternPoint pattern_at(const ReferenceBody& body, const Hit& hit) {
  const Vec3 point = transform_point(body.pattern_from_local, hit.local);
  if (body.kind == BodyKind::sphere) return {point, -1};
  // A facet at 45 degrees has two dominant axes; the first one counts, not the one that rounding favours.
  Vec3 n = glm::abs(glm::normalize(body.pattern_normal_from_local * local_normal(body, hit)));
  n.x += 0x1p-20, n.y += 0x1p-21;
  return {point, dominant_axis(n)};
}

std::optional<Hit> hit_same_surface(const ReferenceBody& body, const Hit& hit, const Vec3& origin,
                                    const Vec3& direction) {
  const Vec3 o = body.local_point(origin), d = body.local_from_world * direction;
  if (body.kind == BodyKind::sphere) {
    const auto roots = sphere_roots(o, d);
    if (!roots) return std::nullopt;
    const bool goes_in = glm::dot(hit.local, d) < 0.0;
    return sphere_hit(hit.body, goes_in ? roots->near : roots->far, o, d);
  }
  const Vec3 n = local_normal(body, hit);
  const double slope = glm::dot(n, d);
  if (slope == 0.0) return std::nullopt;
  Hit moved = hit;
  moved.t = glm::dot(n, hit.local - o) / slope;
  moved.local = o + moved.t * d;
  if (body.kind == BodyKind::mesh) {
    const TriMesh& mesh = *body.mesh->mesh;
    const auto& [ia, ib, ic] = corners(mesh, hit.primitive);
    const Vec3 e1 = mesh.positions[ib] - mesh.positions[ia], e2 = mesh.positions[ic] - mesh.positions[ia];
    const Vec3 p = moved.local - mesh.positions[ia], area = glm::cross(e1, e2);
    const double area2 = glm::dot(area, area);
    const double v = glm::dot(glm::cross(p, e2), area) / area2, w = glm::dot(glm::cross(e1, p), area) / area2;
    moved.barycentric = Vec3(1.0 - v - w, v, w);
  }
  return moved;
}

std::vector<double> exit_distances(const ReferenceBody& body, const Vec3& point, const Vec3& direction) {
  const Vec3 o = body.local_point(point), d = body.local_from_world * direction;
  if (body.kind != BodyKind::mesh) {
    const AnalyticHits found = analytic_hits(body, 0, Ray{.origin = point, .direction = direction});
    const bool is_inside = found.count == 2 && found.hits[0].t < 0.0 && found.hits[1].t > 0.0;
    return is_inside ? std::vector{found.hits[1].t} : std::vector<double>{};
  }
  // The winding number: ways out less ways in along the ray (never parity, which one flipped face would break).
  const ShearedRay ray(o, d);
  const double everywhere = kInfinity;
  std::map<double, int, std::greater<>> exits;  // by distance, the farthest first; less the entries
  body.mesh->tree.visit(o, d, 0.0, everywhere, [&](uint32_t triangle) {
    const auto hit = triangle_hit(*body.mesh->mesh, 0, triangle, ray);
    if (hit && hit->t > 0.0) exits[hit->t] += glm::dot(local_normal(body, *hit), d) > 0.0 ? 1 : -1;
    return false;
  });
  // Back from beyond everything, where the number is 0: the solid ends for the n-th time where the number has come to n
  // for good. Places closer together than rounding are one.
  std::vector<double> ends;
  int around = 0;
  for (auto at = exits.begin(); at != exits.end();) {
    const double place = at->first;
    for (; at != exits.end() && at->first >= place * (1.0 - kRounding); ++at) around += at->second;
    const auto count = static_cast<size_t>(std::max(around, 0));
    ends.resize(std::min(ends.size(), count));
    ends.resize(count, place);
  }
  return ends;
}

}  // namespace tilelight::reference
