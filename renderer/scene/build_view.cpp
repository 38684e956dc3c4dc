// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include "renderer/scene/build.h"
#include "renderer/scene/readers.h"

namespace tilelight {
namespace {

constexpr int kDefaultSamples = 16;

Camera build_camera(Value value, Problems& problems) {
  Camera camera;
  camera.projection = read_word(value, "type", kProjections, camera.projection);
  camera.position = read_vector(value, "position", camera.position);
  camera.target = read_vector(value, "target", camera.target);
  camera.up = read_vector(value, "up", camera.up);
  camera.fov_y_deg = read_number(value, "fov_y_deg", camera.fov_y_deg);
  camera.height = read_number(value, "height", camera.height);
  // A place that was refused says nothing about the direction of view.
  const auto is_sound = [value](const char* key) { return !value.find(key) || !value.find(key).is_rejected(); };
  if (!value.find("position") || !is_sound("position") || !is_sound("target")) return camera;
  if (camera.position == camera.target) {
    problems.add(value.find("position"), {"out_of_range",
                                          "found position equal to target; allowed: two different points",
                                          {},
                                          value.find("target") ? "" : "target is the origin unless it is given"});
  }
  return camera;
}

ImageSpec build_image(Value value, const Limits& limits, Problems& problems) {
  ImageSpec image;
  image.width = read_int(value, "width", image.width);
  image.height = read_int(value, "height", image.height);
  image.exposure = read_number(value, "exposure", image.exposure);
  const int64_t pixels = int64_t{image.width} * image.height;
  if (pixels > limits.pixels) {
    problems.add(value,
                 {"limit",
                  "found " + std::to_string(image.width) + " x " + std::to_string(image.height) + " = " +
                      std::to_string(pixels) + " pixels; allowed: " + std::to_string(limits.pixels) + " (limit pixels)",
                  {},
                  ""});
  }
  return image;
}

void build_stop_rules(Value value, RenderSpec& render, const Limits& limits, Problems& problems) {
  if (const Value time = find_accepted(value, "time_ms")) render.time_ms = time.number();
  if (const Value rmse = find_accepted(value, "rmse")) render.rmse = rmse.number();
  if (const Value passes = find_accepted(value, "passes")) {
    render.passes.assign(passes.numbers().begin(), passes.numbers().end());
    const double sum = std::accumulate(render.passes.begin(), render.passes.end(), 0.0);
    if (sum > limits.samples) {
      problems.add(passes, {"limit",
                            "found " + std::to_string(static_cast<int64_t>(sum)) +
                                " samples a pixel in all passes; allowed: " + std::to_string(limits.samples) +
                                " (limit samples)",
                            {},
                            ""});
    } else {
      render.samples = static_cast<int>(std::ceil(sum));
    }
    // 1/16 is a sketch, which no pixel counts; the first pass after it is the first of the film.
    const bool has_sketch = render.passes[0] == 1.0 / 16.0;
    const double first = render.passes[has_sketch && render.passes.size() > 1 ? 1 : 0];
    if (first != std::floor(first) && !(has_sketch && render.passes.size() == 1)) {
      problems.add(passes, {"fractional_first_pass",
                            "found a fraction of a sample in the first pass; allowed: a whole number, for every pixel "
                            "takes as many, or 1/16, for a sketch, and then a whole number",
                            {},
                            ""});
    }
  } else {
    render.samples = render.rmse || render.time_ms ? limits.samples : std::min(kDefaultSamples, limits.samples);
  }
  if (const Value samples = find_accepted(value, "samples")) {
    render.samples = static_cast<int>(samples.number());
  } else {
    render.samples_implied = true;
  }
}

RenderSpec build_render(Value value, const Limits& limits, Problems& problems) {
  RenderSpec render;
  render.algorithm = read_word(value, "algorithm", kAlgorithms, render.algorithm);
  render.shading = read_word(value, "shading", kShadings, render.shading);
  render.filter = read_word(value, "filter", kFilters, render.filter);
  render.terminator = read_word(value, "terminator", kTerminators, render.terminator);
  render.shadows = read_boolean(value, "shadows", render.shadows);
  render.max_depth = std::min(read_int(value, "max_depth", render.max_depth), limits.max_depth);
  render.weight_cutoff = read_number(value, "weight_cutoff", render.weight_cutoff);
  render.ray_budget = std::min(read_int(value, "ray_budget", render.ray_budget), limits.ray_budget);
  render.tessellate = read_boolean(value, "tessellate", render.tessellate);
  render.chord_error_px = read_number(value, "chord_error_px", render.chord_error_px);
  render.hidden_lines = read_boolean(value, "hidden_lines", render.hidden_lines);
  render.seed = static_cast<uint32_t>(read_number(value, "seed", render.seed));
  build_stop_rules(value, render, limits, problems);
  render.adaptive = read_boolean(value, "adaptive", render.rmse || render.time_ms);
  return render;
}

Light build_light(Value value) {
  Light light;
  light.name = read_text(value, "name");
  light.kind = read_word(value, "type", kLightKinds, light.kind);
  light.position = read_vector(value, "position", light.position);
  light.direction = read_vector(value, "direction", light.direction);
  light.color = read_color(value, "color", light.color);
  light.intensity = read_number(value, "intensity", light.intensity);
  light.shadow = read_boolean(value, "shadow", light.shadow);
  return light;
}

}  // namespace

View build_view(Value root, const Limits& limits, Problems& problems) {
  View view;
  if (const Value camera = find_accepted(root, "camera")) view.camera = build_camera(camera, problems);
  const Value image = root.find("image"), render = root.find("render");
  view.image = build_image(image, limits, problems);
  view.render = build_render(render, limits, problems);
  return view;
}

std::vector<Light> build_lights(Value lights) {
  if (!lights) {  // fixed in the world: a key with shadow and a fill without
    Light key, fill;
    key.kind = fill.kind = LightKind::directional;
    key.direction = {-1.0, -2.0, -1.5};
    key.intensity = 0.7;
    fill.direction = {1.0, -1.0, -0.5};
    fill.intensity = 0.25;
    fill.shadow = false;
    return {key, fill};
  }
  std::vector<Light> built;
  if (lights.is_rejected()) return built;
  for (const Value value : lights.children()) {
    if (!value.is_rejected()) built.push_back(build_light(value));
  }
  return built;
}

}  // namespace tilelight
