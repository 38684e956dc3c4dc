// SPDX-License-Identifier: Apache-2.0
#include "renderer/check/kit/textbook.h"

#include <limits>

#include "renderer/base/elementary.h"
#include "renderer/film/sampling.h"
#include "renderer/film/tone.h"

namespace tilelight::check {
namespace {

using naive::RayF;

Vec3f transform(const glm::mat4& m, const Vec3f& p) { return Vec3f(m * glm::vec4(p, 1.0f)); }

Color plain(const Paint& paint) {
  const auto* color = std::get_if<Color>(&paint);
  return color ? *color : std::get<Checker>(paint).a;
}

// A ray in the local space of a solid, its direction as long as it comes, so that t stays the same.
RayF to_local(const glm::mat4& local_from_world, const RayF& ray) {
  return {transform(local_from_world, ray.origin), glm::mat3(local_from_world) * ray.direction};
}

}  // namespace

TextbookTracer::TextbookTracer(const Scene& scene, float epsilon)
    : lights_(scene.lights),
      attenuation_(scene.attenuation),
      background_(scene.background),
      ambient_(scene.ambient),
      epsilon_(epsilon) {
  for (const Body& body : make_bodies(scene)) {
    const Material& m = scene.materials[body.material];
    Solid solid{body.kind,
                glm::mat4(body.world_from_local),
                glm::inverse(glm::mat4(body.world_from_local)),
                Vec3f(body.half),
                plain(m.ambient),
                plain(m.diffuse),
                m.specular,
                static_cast<float>(m.shininess),
                {},
                Vec3f(0.0f),
                0.0f};
    if (body.kind == BodyKind::mesh) {
      for (const auto& triangle : body.mesh->triangles)
        for (const uint32_t v : triangle)
          solid.corners.push_back(transform(solid.world_from_local, Vec3f(body.mesh->positions[v])));
      for (const Vec3f& p : solid.corners) solid.ball_center += p / static_cast<float>(solid.corners.size());
      for (const Vec3f& p : solid.corners)
        solid.ball_radius = std::max(solid.ball_radius, glm::length(p - solid.ball_center));
    }
    solids_.push_back(std::move(solid));
  }
}

void TextbookTracer::offer(uint32_t body, const RayF& ray, float t_min, Hit& best) const {
  const Solid& solid = solids_[body];
  const auto take = [&](float t, uint32_t prim, const Vec3f& normal) {
    if (best.is_hit() && !(t < best.t)) return;
    const Vec3f unit = glm::normalize(normal);
    best = {t, uint64_t{body} << 32 | prim, glm::dot(unit, ray.direction) < 0.0f ? unit : -unit};
  };
  if (solid.kind == BodyKind::mesh) {
    if (!naive::sphere(ray, solid.ball_center, solid.ball_radius, 0.0f)) return;
    for (size_t i = 0; i < solid.corners.size(); i += 3) {
      const Vec3f &a = solid.corners[i], &b = solid.corners[i + 1], &c = solid.corners[i + 2];
      if (const auto hit = naive::triangle(ray, a, b, c, t_min))
        take(hit->t, static_cast<uint32_t>(i / 3), glm::cross(b - a, c - a));
    }
    return;
  }
  const RayF local = to_local(solid.local_from_world, ray);
  const glm::mat3 world_from_normal = glm::transpose(glm::mat3(solid.local_from_world));
  if (solid.kind == BodyKind::sphere) {
    if (const auto t = naive::sphere(local, Vec3f(0.0f), 1.0f, t_min))
      take(*t, 0, world_from_normal * (local.origin + *t * local.direction));
  } else if (solid.kind == BodyKind::plane) {
    const float t = -local.origin.y / local.direction.y;
    if (t > t_min) take(t, 0, world_from_normal * Vec3f(0.0f, 1.0f, 0.0f));
  } else if (const auto hit = naive::slabs(local, -solid.half, solid.half, true)) {
    const float t = hit->near > t_min ? hit->near : hit->far;
    if (!(t > t_min)) return;
    const Vec3f at = (local.origin + t * local.direction) / solid.half;
    const Vec3f size = glm::abs(at);
    const int axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
    Vec3f normal(0.0f);
    normal[axis] = at[axis] > 0.0f ? 1.0f : -1.0f;
    take(t, static_cast<uint32_t>(2 * axis + (at[axis] > 0.0f ? 1 : 0)), world_from_normal * normal);
  }
}

TextbookTracer::Hit TextbookTracer::nearest(const RayF& ray, float t_min) const {
  Hit best;
  for (uint32_t body = 0; body < solids_.size(); ++body) offer(body, ray, t_min, best);
  return best;
}

bool TextbookTracer::is_blocked(const RayF& ray, float t_min, float distance) const {
  const Hit hit = nearest(ray, t_min);
  return hit.is_hit() && hit.t < distance;
}

glm::vec3 TextbookTracer::shade(const RayF& ray, const Hit& hit, bool shadows, bool& is_lit) const {
  if (!hit.is_hit()) {
    const double up = 0.5 * (1.0 + ray.direction.y);
    return Vec3f(background_.bottom * (1.0 - up) + background_.top * up);
  }
  const Solid& solid = solids_[hit.id >> 32];
  const Vec3f place = ray.origin + hit.t * ray.direction;
  Vec3f sum(ambient_ * solid.ambient);
  for (const Light& light : lights_) {
    const bool is_point = light.kind == LightKind::point;
    const Vec3f path = is_point ? Vec3f(light.position) - place : -Vec3f(light.direction);
    const float distance = is_point ? glm::length(path) : std::numeric_limits<float>::infinity();
    const Vec3f to_light = glm::normalize(path);
    const float cosine = glm::dot(hit.normal, to_light);
    if (!(cosine > 0.0f)) continue;
    if (shadows && light.shadow && is_blocked({place, to_light}, epsilon_, distance)) continue;
    is_lit = true;
    const float k = static_cast<float>(attenuation_.k);
    float factor = 1.0f;
    if (is_point && attenuation_.mode == AttenuationMode::linear) factor = 1.0f / (distance + k);
    if (is_point && attenuation_.mode == AttenuationMode::inverse_square) factor = 1.0f / (distance * distance + k);
    const Vec3f mirrored = 2.0f * cosine * hit.normal - to_light;
    const double along = glm::dot(mirrored, -ray.direction);
    const double lobe = along > 0.0 ? elementary::pow(along, solid.shininess) : 0.0;
    sum +=
        Vec3f(light.color * light.intensity) * factor * (Vec3f(solid.diffuse) * cosine + Vec3f(solid.specular * lobe));
  }
  return sum;
}

TextbookTracer::Picture TextbookTracer::picture(const View& view, const Camera& camera, TilePool& pool) const {
  const int width = view.image.width, height = view.image.height;
  const Vec3f eye(camera.position);
  const Vec3f forward = glm::normalize(Vec3f(camera.target) - eye);
  const Vec3f right = glm::normalize(glm::cross(forward, Vec3f(camera.up)));
  const Vec3f up = glm::cross(right, forward);
  const auto half_height = static_cast<float>(elementary::tan(elementary::rad_from_deg(0.5 * camera.fov_y_deg)));
  const float px = 2.0f * half_height / static_cast<float>(height);

  const size_t pixels = static_cast<size_t>(width) * static_cast<size_t>(height);
  Picture out{std::vector<uint64_t>(pixels), {}, std::vector<uint8_t>(pixels), 0};
  Image image{width, height, std::vector<float>(3 * pixels)};
  pool.parallel_for(height, Priority::batch, [&](int64_t row) {
    const auto y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      const SamplePoint p = sample_point(x, y, view.render.seed, 0);
      const float dx = (static_cast<float>(x + p.x) - 0.5f * static_cast<float>(width)) * px;
      const float dy = (static_cast<float>(y + p.y) - 0.5f * static_cast<float>(height)) * px;
      const RayF ray{eye, glm::normalize(forward + dx * right - dy * up)};
      const Hit hit = nearest(ray, 0.0f);
      bool is_lit = false;
      const Vec3f color = shade(ray, hit, view.render.shadows, is_lit);
      const size_t i = static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
      out.ids[i] = hit.id;
      out.lit[i] = is_lit;
      for (int c = 0; c < 3; ++c) image.rgb[3 * i + static_cast<size_t>(c)] = color[c];
    }
  });
  for (size_t i = 0; i < pixels; ++i)
    out.nonfinite += !(std::isfinite(image.rgb[3 * i]) && std::isfinite(image.rgb[3 * i + 1]) &&
                       std::isfinite(image.rgb[3 * i + 2]));
  out.rgb = to_srgb8(image, view.image.exposure);
  return out;
}

}  // namespace tilelight::check
