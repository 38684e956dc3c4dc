// SPDX-License-Identifier: Apache-2.0
#include "renderer/raster/lines/line_bodies.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <glm/gtc/matrix_access.hpp>

#include "renderer/base/facet.h"

namespace tilelight::lines {
namespace {

// A convex body of more faces hides as its faces: of these a line meets a few, of the body it would be asked for all.
constexpr size_t kMostFacesOfWhole = 6000;  // at 5,000 both take the same time, at 20,000 faces take half

void place_points(LineBody& out, const CompiledBody& body, const LineView& view) {
  const auto place = [&](const Vec3& local) {
    out.points.push_back(view.from_world(transform_point(body.world_from_local, local)));
  };
  if (body.kind == BodyKind::mesh) {
    for (const Vec3& p : body.mesh->positions) place(p);
  } else {
    for (int v = 0; v < 8; ++v) place(body.half * Vec3(v & 1 ? 1.0 : -1.0, v & 2 ? 1.0 : -1.0, v & 4 ? 1.0 : -1.0));
  }
  if (out.points.empty()) return;
  out.lo = out.hi = out.points[0];
  for (const Vec3& p : out.points) out.lo = glm::min(out.lo, p), out.hi = glm::max(out.hi, p);
}

void place_faces(LineBody& out, const CompiledBody& body, const LineView& view) {
  out.is_mirrored = glm::determinant(Mat3(body.world_from_local)) < 0.0;
  for (size_t f = 0; f < out.shape->faces.size(); ++f) {
    const LineFace& face = out.shape->faces[f];
    Vec3 normal;
    if (body.kind == BodyKind::box) {  // whose faces may have no area
      const Vec3 outward = body.world_from_normal[static_cast<int>(f / 2)] * (f % 2 ? 1.0 : -1.0);
      normal = unit_or_zero(view.direction_from_world(outward));
    } else {
      const auto [a, b, c] =
          std::tie(out.points[face.vertex[0]], out.points[face.vertex[1]], out.points[face.vertex[2]]);
      normal = geometric_normal(a, b, c) * (out.is_mirrored ? -1.0 : 1.0);
    }
    out.normals.push_back(normal);
    out.facing.push_back(static_cast<int8_t>(view.facing(normal, out.points[face.vertex[0]])));
  }
}

bool is_seen_from_outside(const LineBody& body, const LineView& view) {
  if (!view.is_perspective()) return !body.is_cut;
  if (body.shape->is_convex) return std::find(body.facing.begin(), body.facing.end(), 1) != body.facing.end();
  const Vec3 eye = view.eye();
  for (int k = 0; k < 3; ++k)
    if (eye[k] < body.lo[k] || eye[k] > body.hi[k]) return true;
  return false;
}

}  // namespace

Polygon LineBody::polygon(uint32_t face) const {
  const LineFace& f = shape->faces[face];
  const bool is_reversed = (facing[face] < 0) != is_mirrored;
  const auto point = [&](uint32_t c) -> const Vec3& {
    return points[f.vertex[is_reversed ? f.corners - 1 - c % f.corners : c % f.corners]];
  };
  Polygon out;
  for (uint32_t c = 0; c < f.corners; ++c) {
    const Vec3 &p = point(c), &next = point(c + 1);
    const bool is_seen = !is_cut || p.z >= 0.0, is_next_seen = !is_cut || next.z >= 0.0;
    if (is_seen) out.corner[out.corners++] = p;
    if (is_seen == is_next_seen) continue;
    const Vec3 &seen = is_seen ? p : next, &unseen = is_seen ? next : p;  // the same bits for both faces of an edge
    Vec3& cut = out.corner[out.corners++] = between(seen, unseen, seen.z / (seen.z - unseen.z));
    cut.z = 0.0;
  }
  return out;
}

LineBodies place_bodies(const CompiledScene& scene, const LineView& view, TilePool& pool) {
  LineBodies out;
  std::vector<std::pair<const CompiledMesh*, std::unique_ptr<const LineShape>*>> to_make;
  for (size_t i = 0; i < scene.finite_bodies; ++i) {
    if (scene.bodies[i].kind == BodyKind::sphere) continue;
    const auto [at, is_new] = out.shapes.try_emplace(scene.bodies[i].mesh);
    if (is_new) to_make.emplace_back(at->first, &at->second);
  }
  pool.parallel_for(static_cast<int64_t>(to_make.size()), Priority::normal, [&](int64_t i) {
    const auto& [mesh, shape] = to_make[i];
    *shape = std::make_unique<const LineShape>(mesh ? make_mesh_shape(*mesh) : make_box_shape());
  });
  out.finite.resize(scene.finite_bodies);
  pool.parallel_for(static_cast<int64_t>(scene.finite_bodies), Priority::normal, [&](int64_t i) {
    const CompiledBody& body = scene.bodies[i];
    if (body.kind == BodyKind::sphere) return;
    LineBody& placed = out.finite[i];
    placed.shape = out.shapes.find(body.mesh)->second.get();
    place_points(placed, body, view);
    place_faces(placed, body, view);
    placed.is_cut = !view.is_perspective() && placed.lo.z < 0.0;
    placed.hides_backs = placed.shape->is_outward && is_seen_from_outside(placed, view);
    placed.is_whole = placed.shape->is_convex && placed.hides_backs && placed.shape->faces.size() <= kMostFacesOfWhole;
  });
  for (size_t i = scene.finite_bodies; i < scene.bodies.size(); ++i) {
    const CompiledBody& body = scene.bodies[i];
    const Vec3 normal = unit_or_zero(view.direction_from_world(Vec3(glm::row(body.local_from_world, 1))));
    const Vec3 point = view.from_world(Vec3(body.world_from_local[3]));
    out.planes.push_back({static_cast<uint32_t>(i), {normal, glm::dot(normal, point)}});
  }
  return out;
}

}  // namespace tilelight::lines
