// SPDX-License-Identifier: Apache-2.0
#include "renderer/measure/reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <utility>

#include "renderer/base/elementary.h"
#include "renderer/measure/reference_bounce.h"
#include "renderer/measure/reference_light.h"
#include "renderer/measure/reference_media.h"
#include "renderer/scene/camera_up.h"
#include "renderer/trace/pixel_filter.h"

namespace tilelight {
namespace {

using namespace reference;  // NOLINT(google-build-using-namespace): the parts of this renderer

// The neighbours that travel with a ray are so many pixels apart from it, to tell how large a pixel is where it lands.
constexpr double kNeighbourPx = 1.0 / 64.0;

struct Line {
  Vec3 origin, direction;
};

// The same ray one small step to the right and one down in the image. None once one of them has missed the surface that
// the ray itself has hit.
using Neighbours = std::optional<std::array<Line, 2>>;

struct PathRay {
  ReferenceRayKind kind = ReferenceRayKind::primary;
  int depth = 0;
  Ray ray{};
  Neighbours neighbours{};
  Color weight{1.0};
  MediaStack media{};
};

double largest(const Color& c) { return std::max({c.x, c.y, c.z}); }

Vec3 unit(const Vec3& v) {  // also of vectors whose squares would underflow
  const Vec3 a = glm::abs(v);
  return glm::normalize(v / std::max({a.x, a.y, a.z}));
}

// Up parallel to the view says nothing: then +y is up and, where the view is vertical, what puts +x on the right.
Vec3 up_in_picture(const Vec3& up, const Vec3& forward) {
  const Vec3 y(0, 1, 0);
  if (glm::length(glm::cross(forward, unit(up))) > kUpAlongViewSine) return unit(up);
  if (glm::length(glm::cross(forward, y)) > kUpAlongViewSine) return y;
  return glm::cross(Vec3(1, 0, 0), forward);
}

Line eye_line(const ReferenceEye& eye, const Vec2& p) {
  const Vec3 across = (p.x - eye.center_x) * eye.right + (p.y - eye.center_y) * eye.down;
  if (eye.is_perspective) return {eye.position, glm::normalize(eye.forward + across)};
  return {eye.position + across, eye.forward};
}

// One sample of one pixel, ray by ray.
class Sample {
 public:
  Sample(const ReferenceScene& scene, const ReferenceEye& eye, std::vector<ReferenceRay>* log)
      : scene_(scene), render_(eye.render), log_(log) {}

  ReferencePixel trace(const ReferenceEye& eye, const Vec2& p) {
    const Line axis = eye_line(eye, p);
    PathRay first{.ray = {.origin = axis.origin, .direction = axis.direction},
                  .media = MediaStack(eye.is_perspective ? eye.media : scene_.media_around(axis.origin))};
    first.neighbours = {eye_line(eye, p + Vec2(kNeighbourPx, 0.0)), eye_line(eye, p + Vec2(0.0, kNeighbourPx))};
    queue_.push_back(std::move(first));
    while (!queue_.empty()) {
      const PathRay path = std::move(queue_.front());
      queue_.pop_front();
      follow(path);
    }
    return pixel_;
  }

 private:
  void follow(const PathRay& start) {
    PathRay path = start;
    MediaStack beyond;
    const auto hit = first_visible(path, beyond);
    if (log_) log(start, hit);
    if (!hit) {
      pixel_.color += path.weight * background_at(scene_.background(), path.ray.direction);
      return;
    }
    if (path.kind == ReferenceRayKind::primary) pixel_.primary_id = surface_id(hit->body, hit->primitive);
    const ReferenceBody& body = scene_.body(hit->body);
    const ShadingPoint at = shading_point(body, *hit, path.ray.direction);
    pixel_.color += path.weight * local_light(scene_, at, render_);
    note_checker(path, *hit);
    spawn(path, at, beyond);
  }

  // The first surface that is there: a place with the same medium on both sides is passed through, unbent. path.media
  // become those before it, `beyond` those behind.
  std::optional<Hit> first_visible(PathRay& path, MediaStack& beyond) {
    while (const auto hit = scene_.nearest(path.ray)) {
      beyond = path.media;
      if (!scene_.is_medium(hit->body)) return hit;
      const std::vector<Hit> surfaces = scene_.surfaces_at(path.ray, *hit);
      if (!scene_.is_medium(surfaces[0].body)) return surfaces[0];
      Interface interface = make_interface(scene_, path.media, surfaces, path.ray.direction);
      path.media = interface.shown ? interface.here : interface.beyond;
      beyond = std::move(interface.beyond);
      if (interface.shown) return interface.shown;
      path.ray = scene_.ray_from(*hit, path.ray.direction, Coincident::none);
    }
    return std::nullopt;
  }

  void spawn(const PathRay& path, const ShadingPoint& at, const MediaStack& beyond) {
    const Material& material = scene_.material(at.hit.body);
    Color kr = material.reflection, kt = material.transmission;
    if (largest(kr) <= 0.0 && largest(kt) <= 0.0) return;
    double ior_from = 1.0, ior_to = 1.0;  // alike for thin bodies: straight on
    Coincident onward = Coincident::none, back = Coincident::before;
    if (scene_.is_medium(at.hit.body)) {
      ior_from = path.media.ior(scene_), ior_to = beyond.ior(scene_);
    } else if (largest(kt) > 0.0) {
      const bool goes_back = path.ray.coincident == Coincident::before && scene_.is_at_start(path.ray, at.hit);
      onward = goes_back ? Coincident::before : Coincident::after;
      back = goes_back ? Coincident::after : Coincident::before;
    }
    const auto through_of = [&](const Vec3& d, const ShadingPoint& s) {
      return refracted(d, s.geometric, s.shading, facet_spread(scene_.body(s.hit.body), s.hit), ior_from, ior_to);
    };
    const Refraction through = through_of(path.ray.direction, at);
    if (material.fresnel && scene_.is_medium(at.hit.body)) {
      kr *= through.fresnel, kt *= 1.0 - through.fresnel;
    } else if (!through.direction) {
      kr += kt, kt = Color(0.0);
    }
    const Vec3 mirror = reflected(path.ray.direction, at.geometric, at.shading);
    push(path, at, ReferenceRayKind::reflected, kr, mirror, path.media, back,
         [](const Vec3& d, const ShadingPoint& s) { return std::optional(reflected(d, s.geometric, s.shading)); });
    push(path, at, ReferenceRayKind::refracted, kt, through.direction.value_or(mirror), beyond, onward,
         [&](const Vec3& d, const ShadingPoint& s) { return through_of(d, s).direction; });
  }

  // Queues a child ray if depth, weight and budget allow it. `turn` gives the neighbours' new directions.
  template <class Turn>
  void push(const PathRay& path, const ShadingPoint& at, ReferenceRayKind kind, const Color& k, const Vec3& direction,
            MediaStack media, Coincident coincident, Turn turn) {
    const Color weight = path.weight * k;
    if (largest(weight) <= 0.0) return;
    if (path.depth >= render_.max_depth || largest(weight) < render_.weight_cutoff || spawned_ >= render_.ray_budget) {
      pixel_.untraced += weight;
      return;
    }
    ++spawned_;
    PathRay child{.kind = kind, .depth = path.depth + 1, .weight = weight, .media = std::move(media)};
    child.ray = scene_.ray_from(at.hit, direction, coincident);
    child.neighbours = turned(path.neighbours, at, turn);
    queue_.push_back(std::move(child));
  }

  template <class Turn>
  Neighbours turned(const Neighbours& lines, const ShadingPoint& at, Turn turn) const {
    if (!lines) return std::nullopt;
    std::array<Line, 2> result;
    for (int i = 0; i < 2; ++i) {
      const auto& [origin, direction] = (*lines)[i];
      const auto hit = hit_same_surface(scene_.body(at.hit.body), at.hit, origin, direction);
      if (!hit) return std::nullopt;
      const ShadingPoint s = shading_point(scene_.body(at.hit.body), *hit, direction);
      const std::optional<Vec3> next = turn(direction, s);
      if (s.is_inside != at.is_inside || !next) return std::nullopt;
      result[i] = {s.point, *next};
    }
    return result;
  }

  void note_checker(const PathRay& path, const Hit& hit) {
    const Material& material = scene_.material(hit.body);
    for (const Paint* paint : {&material.diffuse, &material.ambient}) {
      if (const Checker* checker = std::get_if<Checker>(paint))
        pixel_.checker_cell_px = std::min(pixel_.checker_cell_px, checker->size / pattern_step(path, hit));
    }
  }

  // How far the pattern point moves from one pixel to the next.
  double pattern_step(const PathRay& path, const Hit& hit) const {
    if (!path.neighbours) return std::numeric_limits<double>::infinity();
    const ReferenceBody& body = scene_.body(hit.body);
    const PatternPoint here = pattern_at(body, hit);
    double step = 0.0;
    for (const Line& line : *path.neighbours) {
      const auto neighbour = hit_same_surface(body, hit, line.origin, line.direction);
      if (!neighbour) return std::numeric_limits<double>::infinity();
      const Vec3 moved = pattern_at(body, *neighbour).point - here.point;
      for (int axis = 0; axis < 3; ++axis)
        if (axis != here.ignored_axis) step = std::max(step, std::fabs(moved[axis]) / kNeighbourPx);
    }
    return step;
  }

  void log(const PathRay& path, const std::optional<Hit>& hit) {
    ReferenceRay ray{path.kind, path.depth, path.ray.origin, path.ray.direction, path.weight};
    if (hit) {
      ray.hit_id = surface_id(hit->body, hit->primitive);
      ray.hit_point = scene_.body(hit->body).world_point(hit->local);
    }
    log_->push_back(ray);
  }

  const ReferenceScene& scene_;
  const RenderSpec& render_;
  std::vector<ReferenceRay>* log_;
  std::deque<PathRay> queue_;
  int spawned_ = 0;
  ReferencePixel pixel_;
};

}  // namespace

ReferenceEye make_reference_eye(const ReferenceScene& scene, const View& view, const Camera& camera) {
  ReferenceEye eye;
  eye.position = camera.position;
  eye.forward = unit(camera.target - camera.position);
  const Vec3 right = glm::normalize(glm::cross(eye.forward, up_in_picture(camera.up, eye.forward)));
  const Vec3 up = glm::cross(right, eye.forward);
  eye.is_perspective = camera.projection == Projection::perspective;
  const double plane_height =
      eye.is_perspective ? 2.0 * elementary::tan(0.5 * elementary::rad_from_deg(camera.fov_y_deg)) : camera.height;
  const double pixel = plane_height / view.image.height;
  eye.right = pixel * right, eye.down = -pixel * up;
  eye.center_x = 0.5 * view.image.width, eye.center_y = 0.5 * view.image.height;
  if (eye.is_perspective) eye.media = scene.media_around(camera.position);
  eye.render = view.render;
  return eye;
}

ReferencePixel reference_sample(const ReferenceScene& scene, const ReferenceEye& eye, const Vec2& image_point,
                                std::vector<ReferenceRay>* rays) {
  return Sample(scene, eye, rays).trace(eye, image_point);
}

std::vector<ReferencePixel> reference_image(const ReferenceScene& scene, const View& view, const Camera& camera,
                                            TilePool& pool, uint32_t sample) {
  const ReferenceEye eye = make_reference_eye(scene, view, camera);
  const int width = view.image.width, height = view.image.height;
  std::vector<ReferencePixel> pixels(static_cast<size_t>(width) * height);
  pool.parallel_for(height, Priority::batch, [&](int64_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      const SamplePoint s = through_filter(view.render.filter, sample_point(x, y, view.render.seed, sample));
      pixels[static_cast<size_t>(y) * width + x] = reference_sample(scene, eye, Vec2(x + s.x, y + s.y));
    }
  });
  return pixels;
}

}  // namespace tilelight
