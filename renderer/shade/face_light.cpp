// SPDX-License-Identifier: Apache-2.0
#include "renderer/shade/face_light.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "renderer/base/hash.h"
#include "renderer/base/safe_length.h"

namespace tilelight {
namespace {

// The two axes along a box's face, and the face's own.
struct FaceAxes {
  int across, u, v;
  explicit FaceAxes(uint32_t prim) : across(static_cast<int>(prim / 2)), u((across + 1) % 3), v((across + 2) % 3) {}
};

LocalPoint box_point(const CompiledBody& body, uint32_t prim, double u, double v) {
  const FaceAxes axes(prim);
  const double side = prim % 2 ? 1.0 : -1.0;
  LocalPoint out;
  out.position[axes.across] = side * body.half[axes.across];
  out.position[axes.u] = u * body.half[axes.u];
  out.position[axes.v] = v * body.half[axes.v];
  out.geometric[axes.across] = side;
  return out;
}

// Of a place between -half and half, from 0 to 1.
double part_of(double place, double half) { return half > 0.0 ? std::clamp(0.5 + 0.5 * place / half, 0.0, 1.0) : 0.5; }

}  // namespace

FaceLight::FaceLight(const CompiledScene& scene, Shading shading, bool smooth_terminator)
    : scene_(scene), shading_(shading), smooth_terminator_(smooth_terminator) {
  if (shading == Shading::phong) return;
  constexpr size_t kBytes = 1 << 18;  // beside rays and hits in L2
  kept_.resize(std::bit_floor(kBytes / sizeof(Face)));
}

int FaceLight::corners_of(const CompiledBody& body) const {
  if (shading_ == Shading::flat) return 1;
  return body.kind == BodyKind::box ? 4 : 3;
}

LocalPoint FaceLight::corner(const CompiledBody& body, uint32_t prim, int index) const {
  if (body.kind == BodyKind::box) {
    if (shading_ == Shading::flat) return box_point(body, prim, 0.0, 0.0);
    return box_point(body, prim, index & 1 ? 1.0 : -1.0, index & 2 ? 1.0 : -1.0);
  }
  if (shading_ == Shading::flat) {
    LocalPoint middle = triangle_point(*body.mesh, prim, 1.0 / 3.0, 1.0 / 3.0);
    middle.is_smooth = false;
    return middle;
  }
  return triangle_point(*body.mesh, prim, index == 0 ? 1.0 : 0.0, index == 1 ? 1.0 : 0.0);
}

std::array<double, FaceLight::kMostCorners> FaceLight::weights_of(const CompiledBody& body, const Hit& hit,
                                                                  const Vec3& position) const {
  if (shading_ == Shading::flat) return {1.0};
  if (body.kind != BodyKind::box) return {hit.b0, hit.b1, 1.0 - hit.b0 - hit.b1};
  const FaceAxes axes(hit.prim);
  const Vec3 local = transform_point(body.local_from_world, position);
  const double u = part_of(local[axes.u], body.half[axes.u]), v = part_of(local[axes.v], body.half[axes.v]);
  return {(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v};
}

// The viewer and not the ray says which side of a face is seen: rays that pass just beside a face seen nearly edge on
// meet its plane on both sides of him, and what is kept must not depend on which came first.
void FaceLight::light_corners(const Hit& hit, const Vec4& viewer, const CompiledLight& light, Corners& brought) const {
  const CompiledBody& body = scene_.bodies[hit.body];
  const bool has_normals = body.kind == BodyKind::mesh && !body.mesh->corner_normals.empty();
  const bool is_lit_over_curve = has_normals && shading_ != Shading::flat && smooth_terminator_;
  const int corners = corners_of(body);
  LocalPoint middle = corner(body, hit.prim, 0);
  for (int i = 1; i < corners; ++i) middle.position += corner(body, hit.prim, i).position;
  const Vec3 center = transform_point(body.world_from_local, middle.position / static_cast<double>(corners));
  Ray seen;
  seen.direction = -way_to_viewer(viewer, center);
  for (int i = 0; i < corners; ++i) {
    Surface at = make_surface_at(scene_, seen, hit, corner(body, hit.prim, i));
    at.diffuse = Color(1.0);
    const LightSample sample = sample_light(scene_, light, at, way_to_viewer(viewer, at.position), is_lit_over_curve);
    brought[static_cast<size_t>(i)] = {sample.arriving, sample.diffuse, sample.specular, sample.is_lit};
  }
}

const FaceLight::Corners& FaceLight::kept_corners(const Hit& hit, const Vec4& viewer, size_t light) {
  const uint64_t name = static_cast<uint64_t>(hit.body) << 32 | hit.prim;
  Face& face = kept_[mix64(mix64(name) + light) & (kept_.size() - 1)];
  if (face.body != hit.body || face.prim != hit.prim || face.light != light) {
    face.body = hit.body, face.prim = hit.prim, face.light = light;
    light_corners(hit, viewer, scene_.lights[light], face.brought);
  }
  return face.brought;
}

LightSample FaceLight::sample(const Hit& hit, const Surface& surface, const Vec4& viewer, bool is_primary,
                              size_t light) {
  const CompiledBody& body = scene_.bodies[hit.body];
  LightSample out;
  const LightWay way = way_to_light(scene_.lights[light], surface.position);
  out.to_light = way.to_light, out.distance = way.distance;
  if (!(way.distance > 0.0)) return out;
  if (!is_primary) light_corners(hit, viewer, scene_.lights[light], brought_);
  const Corners& brought = is_primary ? kept_corners(hit, viewer, light) : brought_;
  const auto weights = weights_of(body, hit, surface.position);
  for (size_t i = 0; i < static_cast<size_t>(corners_of(body)); ++i) {
    out.is_lit |= brought[i].is_lit;
    out.arriving += weights[i] * brought[i].arriving;
    out.diffuse += weights[i] * brought[i].diffuse;
    out.specular += weights[i] * brought[i].specular;
  }
  out.diffuse *= surface.diffuse;
  return out;
}

}  // namespace tilelight
