// SPDX-License-Identifier: Apache-2.0
// C: eyes so far away that even a double cannot hold both their place and a pixel.
#include <cmath>

#include "renderer/base/elementary.h"
#include "renderer/check/rows/cameras.h"
#include "renderer/check/rows/invariance_scene.h"

namespace tilelight::check {
namespace {

// From 1e12 radii away the rays of a perspective eye are parallel: its picture is that of an orthographic one.
Outcome far_eye(const Context& context) {
  constexpr double kDistance = 5e12, kHeight = 7.0;  // the study's radius is about 5
  const auto views = [&](int size_px) {
    ParsedScene flat = study(size_px), far = flat;
    Camera& camera = *flat.view.camera;
    const Vec3 back = glm::normalize(camera.position - camera.target);
    camera.projection = Projection::orthographic;
    camera.height = kHeight;
    camera.position = camera.target + 12.0 * back;
    far.view.camera->position = camera.target + kDistance * back;
    far.view.camera->fov_y_deg = 2.0 * elementary::atan2(0.5 * kHeight, kDistance) / elementary::rad_from_deg(1.0);
    return std::pair(flat, far);
  };
  const auto [flat, far] = views(context.is_quick ? 160 : 512);
  const Picture near_by = picture_of(flat, context.pool), far_away = picture_of(far, context.pool);
  // The reference sends its rays from the eye itself, in double.
  const auto [small_flat, small_far] = views(128);
  const auto plain_ids = [&](const ParsedScene& parsed) { return reference_ids(parsed, context.pool); };
  return {{at_most(0.01, "first surfaces off the orthographic ones, %", differing_ids(near_by.ids, far_away.ids)),
           at_most(0.02, "pixels off the orthographic ones, %", differing_pixels(near_by.rgb, far_away.rgb))},
          {at_most(0.01, "first surfaces off the orthographic ones, %",
                   differing_ids(plain_ids(small_flat), plain_ids(small_far)))}};
}

// A picture of 1e-9 in a scene of size 1, from 1e6 away: there doubles lie 1e-10 apart.
Outcome far_parallel(const Context& context) {
  constexpr double kHeight = 1e-9;
  const int size = context.is_quick ? 128 : 512, small = 128;
  const Strips strips{.count = 64, .width = kHeight / 60.0, .half_height = kHeight};
  Camera camera;
  camera.projection = Projection::orthographic;
  camera.position = Vec3(0, 0, 1e6);
  camera.height = kHeight;
  const auto view = [&](int size_px) {
    ParsedScene parsed = view_of_strips(strips, camera, size_px);
    parsed.scene.objects.emplace_back().shape = SphereShape{Vec3(1.5, 0.2, 0.1), 1.0};  // beside the picture
    return parsed;
  };
  const Picture picture = picture_of(view(size), context.pool);
  const std::vector<uint64_t> expected = expected_strips(strips, kHeight, size);
  return {
      {at_most(0.1, "first surfaces off the closed form, %", differing_bodies(expected, picture.ids)),
       at_most(0, "steps back within a row of ids", static_cast<double>(steps_back(picture.ids, size)))},
      {at_most(0.1, "first surfaces off the closed form, %",
               differing_bodies(expected_strips(strips, kHeight, small), reference_ids(view(small), context.pool)))}};
}

constexpr Row kRows[] = {
    {"C6", "eye very far away", "1e12 radii, field 8e-11 degrees", "rays from the eye itself, in double", far_eye},
    {"C7", "parallel rays from very far away", "picture 1e-9 high, eye at 1e6", "starts next to the eye, in double",
     far_parallel},
};

}  // namespace

std::span<const Row> far_camera_rows() { return kRows; }

}  // namespace tilelight::check
