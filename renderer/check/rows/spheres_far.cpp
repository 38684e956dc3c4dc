// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>

#include "renderer/base/elementary.h"
#include "renderer/check/kit/naive.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/kit/shots.h"
#include "renderer/check/kit/textbook.h"
#include "renderer/check/rows/spheres.h"
#include "renderer/film/sampling.h"

namespace tilelight::check {
namespace {

// The last sphere of the scene, in the middle of a square picture: its disc covers pi / (D^2 - 1) of an image plane
// whose edge is 2 tan(fov / 2), D the distance in radii. differing: first surfaces other than the reference's, %.
Outcome middle_of_picture(const ParsedScene& parsed, TilePool& pool, double differing) {
  const auto body = static_cast<uint32_t>(parsed.scene.objects.size() - 1);
  const auto& sphere = std::get<SphereShape>(parsed.scene.objects[body].shape);
  const Camera& camera = *parsed.view.camera;
  const double distance = glm::length(sphere.center - camera.position) / sphere.radius;
  const double half = elementary::tan(elementary::rad_from_deg(0.5 * camera.fov_y_deg));
  const double expected = elementary::kPi / (distance * distance - 1.0) / (4.0 * half * half);

  const Picture picture = picture_of(parsed, pool);
  const std::vector<uint64_t> reference = reference_ids(parsed, pool);
  const auto textbook = TextbookTracer(parsed.scene).picture(parsed.view, camera, pool);
  const std::string what = "first surfaces that differ, %";
  return {{at_most(differing, what, differing_ids(picture.ids, reference)),
           within(2e-3, "area of the disc, relative error", coverage(picture.ids, body) / expected, 1.0)},
          {at_most(differing, what, differing_ids(textbook.ids, reference))}};
}

// Hearn and Baker's form in float, the best of the float forms (Haines et al., Ray Tracing Gems ch. 7).
std::optional<float> hearn_baker(const naive::RayF& ray, const Vec3f& center, float radius) {
  const Vec3f f = ray.origin - center;
  const float a = glm::dot(ray.direction, ray.direction), b = -glm::dot(f, ray.direction);
  const Vec3f nearest = f + (b / a) * ray.direction;
  const float discriminant = radius * radius - glm::dot(nearest, nearest);
  if (discriminant < 0.0f) return std::nullopt;
  const float q = b + std::copysign(std::sqrt(a * discriminant), b);
  const float c = glm::dot(f, f) - radius * radius;
  const float near = std::min(c / q, q / a), far = std::max(c / q, q / a);
  if (!(far > 0.0f)) return std::nullopt;
  return near > 0.0f ? near : far;
}

// How far under the level the ground begins. t_at(direction): the distance of the ground, if it is seen there.
template <class Trace>
double dip_of_horizon(const Vec3& up, const Vec3& level, const Trace& t_at) {
  double sky = 0.0, ground = 2e-3;
  for (int i = 0; i < 48; ++i) {
    const double mid = 0.5 * (sky + ground);
    (t_at(elementary::cos(mid) * level - elementary::sin(mid) * up) ? ground : sky) = mid;
  }
  return ground;
}

struct GroundErrors {
  double t = 0.0, dip = 0.0;  // relative; rad
};

}  // namespace

// The view is along no axis: the ball's centre is (0.48, 0.60, 0.64) D.
Outcome far_ball(const Context& context) {
  const ParsedScene parsed = scene_of(R"({
    "image": {"width": 512, "height": 512},
    "camera": {"position": [0, 0, 0], "target": [4800, 6000, 6400], "fov_y_deg": 0.029335438469855726},
    "objects": [{"type": "sphere", "center": [4800, 6000, 6400]}]})");
  return middle_of_picture(parsed, context.pool, 0.05);
}

Outcome farther_ball(const Context& context) {
  const ParsedScene parsed = scene_of(R"({
    "image": {"width": 512, "height": 512},
    "camera": {"position": [0, 0, 0], "target": [480000, 600000, 640000], "fov_y_deg": 0.00029335439110634063},
    "objects": [{"type": "sphere", "center": [480000, 600000, 640000]}]})");
  return middle_of_picture(parsed, context.pool, 0.0);
}

// The same picture from so far that b^2 - 4ac fails in double as it does in float at 1e4: more digits alone are no
// cure.
Outcome farthest_ball(const Context& context) {
  const ParsedScene parsed = scene_of(R"({
    "image": {"width": 512, "height": 512},
    "camera": {"position": [0, 0, 0], "target": [48e10, 60e10, 64e10], "fov_y_deg": 2.9335439110698147e-10},
    "objects": [{"type": "sphere", "center": [48e10, 60e10, 64e10]}]})");
  Outcome outcome = middle_of_picture(parsed, context.pool, 0.05);
  const ReferenceEye eye = make_reference_eye(ReferenceScene(parsed.scene), parsed.view, *parsed.view.camera);
  const Vec3 f = -std::get<SphereShape>(parsed.scene.objects[0].shape).center;
  std::vector<uint64_t> ids;
  for (int y = 0; y < 512; ++y) {
    for (int x = 0; x < 512; ++x) {
      const SamplePoint p = sample_point(x, y, parsed.view.render.seed, 0);
      const Vec3 d =
          glm::normalize(eye.forward + (x + p.x - eye.center_x) * eye.right + (y + p.y - eye.center_y) * eye.down);
      const double a = glm::dot(d, d), b = 2.0 * glm::dot(f, d), c = glm::dot(f, f) - 1.0;
      ids.push_back(b * b - 4.0 * a * c >= 0.0 ? surface_id(0, 0) : kNothingHit);
    }
  }
  outcome.naive = {
      at_most(0.05, "first surfaces that differ, %", differing_ids(ids, reference_ids(parsed, context.pool)))};
  return outcome;
}

// A scene 1e8 wide, and in it a ball smaller than the spacing of floats there by a factor of 8000; the eye is 25 radii
// away. Rendering relative to the camera would save a float renderer here, world space in float does not.
Outcome speck_far_away(const Context& context) {
  const ParsedScene parsed = scene_of(R"({
    "image": {"width": 512, "height": 512},
    "camera": {"position": [48000000.012, 60000000.015, 64000000.016], "target": [48e6, 60e6, 64e6],
               "fov_y_deg": 11.7},
    "objects": [{"type": "sphere"}, {"type": "sphere", "center": [48e6, 60e6, 64e6], "radius": 1e-3}]})");
  return middle_of_picture(parsed, context.pool, 0.05);
}

// Straight down the ground is h away; the horizon lies acos(r / (r + h)) under the level. At random places of the
// globe, and with the globe, the eye or neither at the origin.
Outcome planet(const Context& context) {
  constexpr double kRadius = 6.371e6, kHeight = 1.7;
  const double ground_dip = std::sqrt(2.0 * kHeight / kRadius);  // less than 1e-9 rad off
  GroundErrors ours, plain, stable;
  Random random(4);
  const auto note_errors = [&](GroundErrors& errors, const Vec3& up, const Vec3& level, const auto& t_at) {
    const std::optional<double> t = t_at(-up);
    note(errors.t, t ? std::abs(*t / kHeight - 1.0) : 1.0);
    note(errors.dip, std::abs(dip_of_horizon(up, level, t_at) - ground_dip));
  };
  for (int place = 0; place < (context.is_quick ? 30 : 600); ++place) {
    const Vec3 up = random.direction(), level = across(up, random), above = (kRadius + kHeight) * up;
    const Vec3 centers[] = {Vec3(0.0), -above, Vec3(1e7, -7e6, 3e6)};
    const Vec3 center = centers[place % 3], eye = center + above;
    const RayScene scene(scene_of_shapes({SphereShape{center, kRadius}}), context.pool);
    note_errors(ours, up, level, [&](const Vec3& direction) -> std::optional<double> {
      const RayScene::Hit hit = scene.nearest(eye, direction);
      return hit.is_hit ? std::optional(hit.t) : std::nullopt;
    });
    note_errors(plain, up, level, [&](const Vec3& direction) -> std::optional<double> {
      return naive::sphere({Vec3f(eye), Vec3f(direction)}, Vec3f(center), kRadius, 0.0f);
    });
    note_errors(stable, up, level, [&](const Vec3& direction) -> std::optional<double> {
      return hearn_baker({Vec3f(eye), Vec3f(direction)}, Vec3f(center), kRadius);
    });
  }
  const std::string t = "t straight down, relative error", dip = "dip of the horizon, rad off";
  return {{at_most(1e-6, t, ours.t), at_most(1e-6, dip, ours.dip)},
          {at_most(1e-6, t + ", b^2 - 4ac", plain.t), at_most(1e-6, dip + ", b^2 - 4ac", plain.dip),
           at_most(1e-6, t + ", Hearn and Baker", stable.t), at_most(1e-6, dip + ", Hearn and Baker", stable.dip)}};
}

}  // namespace tilelight::check
