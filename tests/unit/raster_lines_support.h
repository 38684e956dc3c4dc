// SPDX-License-Identifier: Apache-2.0
// Scenes and views for tests of line drawings.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "renderer/compile/compiled_scene.h"
#include "renderer/raster/lines/line_drawing.h"
#include "renderer/scene/parse.h"
#include "tests/unit/reference_scenes.h"

namespace tilelight::lines_test {

using reference_test::add_object, reference_test::dark_scene;

inline TilePool& pool() {
  static TilePool two_threads(2);
  return two_threads;
}

inline View view_of(const Camera& camera, int width = 800, int height = 600) {
  View view;
  view.camera = camera;
  view.image.width = width, view.image.height = height;
  return view;
}

inline Camera perspective(const Vec3& position, const Vec3& target = Vec3(0.0)) {
  return {.position = position, .target = target, .fov_y_deg = 40.0};
}

inline Camera orthographic(const Vec3& position, double height) {
  return {.projection = Projection::orthographic, .position = position, .height = height};
}

inline LineDrawing draw(const Scene& scene, const View& view, bool with_hidden = false) {
  const auto compiled = compile_scene(scene, pool());
  return draw_lines(*compiled, plan_view(*compiled, view, ""), pool(), with_hidden);
}

inline Scene boxes(const std::vector<BoxShape>& shapes) {
  Scene scene = dark_scene();
  for (const BoxShape& shape : shapes) add_object(scene, shape);
  return scene;
}

inline Scene parsed(const std::string& json, View* view = nullptr) {
  const auto result = parse_scene(json, Limits{});
  EXPECT_TRUE(result) << (result ? "" : result.error().errors[0].detail);
  if (view) *view = result->view;
  return result->scene;
}

inline std::string file_text(const std::string& path) {
  std::ifstream in(std::string(TILELIGHT_SOURCE_DIR) + "/" + path);
  return std::string(std::istreambuf_iterator<char>(in), {});
}

}  // namespace tilelight::lines_test
