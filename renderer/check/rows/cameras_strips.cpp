// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "renderer/check/rows/cameras.h"
#include "renderer/film/sampling.h"
#include "renderer/scene/transform.h"

namespace tilelight::check {

ParsedScene view_of_strips(const Strips& strips, const Camera& camera, int size_px) {
  ParsedScene parsed = scene_of(R"({"objects": [{"type": "box", "min": [0, 0, 0], "max": [1, 1, 1]}]})");
  const Mat3 turn = rotation_about(Vec3(1, 2, 3), 37.0);
  parsed.scene.objects.clear();
  for (int i = 0; i < strips.count; ++i) {
    const double x = (i - strips.count / 2) * strips.width, next = (i + 1 - strips.count / 2) * strips.width;
    Object& strip = parsed.scene.objects.emplace_back();
    strip.shape = BoxShape{Vec3(x, -strips.half_height, -strips.half_height), Vec3(next, strips.half_height, 0.0)};
    strip.world_from_shape = Mat4(turn);
  }
  parsed.view.image.width = parsed.view.image.height = size_px;
  parsed.view.camera = camera;
  Camera& turned = *parsed.view.camera;
  turned.position = turn * camera.position, turned.target = turn * camera.target, turned.up = turn * camera.up;
  return parsed;
}

std::vector<uint64_t> expected_strips(const Strips& strips, double view_height, int size_px) {
  std::vector<uint64_t> bodies;
  for (int y = 0; y < size_px; ++y) {
    for (int x = 0; x < size_px; ++x) {
      const double place = (x + sample_point(x, y, 0, 0).x) / size_px - 0.5;
      bodies.push_back(static_cast<uint64_t>(std::floor(place * view_height / strips.width) + strips.count / 2));
    }
  }
  return bodies;
}

double differing_bodies(const std::vector<uint64_t>& expected_bodies, const std::vector<uint64_t>& ids) {
  size_t count = 0;
  for (size_t i = 0; i < ids.size(); ++i) count += ids[i] >> 32 != expected_bodies[i];
  return 100.0 * static_cast<double>(count) / static_cast<double>(ids.size());
}

int64_t steps_back(const std::vector<uint64_t>& ids, int width) {
  int64_t count = 0;
  for (size_t i = 1; i < ids.size(); ++i)
    count += i % static_cast<size_t>(width) != 0 && ids[i] >> 32 < ids[i - 1] >> 32;
  return count;
}

}  // namespace tilelight::check
