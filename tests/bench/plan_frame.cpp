// SPDX-License-Identifier: Apache-2.0
// plan_frame FEATURE FRAMES WIDTH: renders a scene that uses every feature but one, on one thread, by the kernel
// that its plan chooses, and prints the seconds of each frame and a sum of all its samples. It is built as it
// is, and once more for every feature from kernels that do not know it: tests/bench/plan_proof sets them side by side.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "renderer/compile/compile.h"
#include "renderer/scene/parse.h"
#include "tests/bench/frame.h"
#include "tests/bench/timing.h"

namespace tilelight::bench {
namespace {

std::string scene_without(std::string_view feature) {
  const auto has = [&](std::string_view of) { return feature != of; };
  std::string out = R"({"camera": {"position": [3, 4, 9], "target": [0, 0.8, 0], "fov_y_deg": 40}, "ambient": 0.1,
    "background": {"bottom": [0.1, 0.2, 0.3], "top": [0.5, 0.6, 0.9]},
    "render": {"samples": 1, "max_depth": 3},)";
  if (has("attenuation")) out += R"("attenuation": {"mode": "linear", "k": 6},)";
  if (!has("attenuation")) out += R"("attenuation": {"mode": "none"},)";
  const std::string shadow = has("shadows") ? R"("shadow": true})" : R"("shadow": false})";
  out += R"("lights": [)";
  if (has("point_lights")) out += R"({"type": "point", "position": [4, 7, 5], "intensity": 9, )" + shadow;
  if (has("point_lights") && has("directional_lights")) out += ",";
  if (has("directional_lights"))
    out += R"({"type": "directional", "direction": [1, -2, -1], "intensity": 0.4, )" + shadow;
  out += R"(], "materials": {"dull": {"diffuse": 0.5)";
  if (has("specular")) out += R"(, "specular": 0.4, "shininess": 40)";
  out += R"(, "reflection": 0.2}, "tiled": {"diffuse": )";
  out += has("checker") ? R"({"checker": {"a": 0.1, "b": 0.8, "size": 0.5}})" : "0.6";
  out += R"(, "reflection": 0.2}},
    "meshes": {"roof": {"positions": [-1,0,-1, 1,0,-1, 1,0,1, -1,0,1, 0,1.4,0],
                        "indices": [0,4,1, 1,4,2, 2,4,3, 3,4,0]}}, "objects": [)";
  if (has("spheres")) out += R"({"type": "sphere", "center": [-1.6, 1, 0.4], "radius": 1, "material": "dull"},)";
  if (has("boxes")) out += R"({"type": "cube", "center": [1.7, 0.7, -0.4], "size": 1.4, "material": "tiled"},)";
  if (has("planes")) out += R"({"type": "plane", "point": [0, 0, 0], "normal": [0, 1, 0], "material": "tiled"},)";
  if (has("triangles")) {
    out += R"({"type": "mesh", "mesh": "roof", "translate": [1.7, 1.4, -0.4], "material": "tiled"},)";
    if (has("smooth_normals"))
      out += R"({"type": "chess_piece", "piece": "pawn", "position": [0, 0, 2], "scale": 1.5, "material": "dull"},)";
  }
  out.back() = ']';
  return out + "}";
}

int run(std::string_view feature, int frames, int width) {
  const auto parsed = parse_scene(scene_without(feature), Limits{});
  if (!parsed) {
    const SceneError& error = parsed.error().errors[0];
    std::fprintf(stderr, "plan_frame: %s: %s\n", error.pointer.c_str(), error.detail.c_str());
    return 2;
  }
  TilePool pool(1);
  const auto scene = compile_scene(parsed->scene, pool);
  View view = parsed->view;
  view.image.width = width, view.image.height = width;
  const ViewPlan plan = plan_view(*scene, view, "");
  for (int i = 0; i < kFeatureCount; ++i) {
    if (feature_name(static_cast<Feature>(i)) != feature || !plan.features.has(static_cast<Feature>(i))) continue;
    std::fprintf(stderr, "plan_frame: the scene has %s\n", std::string(feature).c_str());
    return 2;
  }
  for (int frame = 0; frame < frames; ++frame) {
    Film film(width, width);
    film.grow(1);
    const double seconds = seconds_of([&] { render_frame(*scene, plan, pool, film); });
    double sum = 0.0;
    for (int i = 0; i < 3 * width * width; ++i) sum += film.planes()[0][i];
    std::printf("%.9f %.17g\n", seconds, sum);
  }
  return 0;
}

}  // namespace
}  // namespace tilelight::bench

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: plan_frame FEATURE FRAMES WIDTH\n");
    return 2;
  }
  return tilelight::bench::run(argv[1], std::atoi(argv[2]), std::atoi(argv[3]));
}
