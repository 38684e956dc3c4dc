// SPDX-License-Identifier: Apache-2.0
// bench_methods: how the cost of every hidden-surface method grows with pixels, triangles, depth complexity and lights.
// Local light alone, no shadows, one sample a pixel on the same grid for all. Times are of the processor, all threads
// together, from the compiled scene to the picture (a ray tracer's tree is part of the scene), medians of rounds in
// which the methods take turns. Exponents are those of power laws, with 95 % intervals: through the times as they are,
// and through what is added to the smallest one, which takes the fixed costs away.
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <map>
#include <string>
#include <typeinfo>
#include <vector>

#include <CLI/CLI.hpp>

#include "renderer/base/elementary.h"
#include "renderer/raster/method.h"
#include "renderer/renderer.h"
#include "renderer/scene/words.h"
#include "tests/bench/methods_report.h"

namespace tilelight::bench {
namespace {

constexpr double kMostMs = 1500.0;  // a method that takes longer is not asked for more

// A square with sides of 2 before the eye, in cells * cells cells of two triangles, with waves.
MeshData waves(int cells) {
  MeshData mesh;
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) {
      const double x = 2.0 * j / cells - 1.0, y = 2.0 * i / cells - 1.0;
      mesh.positions.emplace_back(x, y, 0.05 * elementary::sin(9.0 * x) * elementary::cos(7.0 * y));
    }
  }
  const auto row = static_cast<uint32_t>(cells + 1);
  for (uint32_t i = 0; i + 1 < row; ++i) {
    for (uint32_t j = 0; j + 1 < row; ++j) {
      const uint32_t a = i * row + j, b = a + 1, c = b + row, d = a + row;
      mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
    }
  }
  return mesh;
}

// Triangles one behind the other, each larger than the picture. The farther ones come first, so that every one of them
// is the nearest when it is drawn.
constexpr double kEyeDistance = 2.4;
MeshData curtains(int count) {
  constexpr double kGap = 0.002;
  MeshData mesh;
  for (int i = count - 1; i >= 0; --i) {
    const double size = 1.0 + i * kGap / kEyeDistance;  // as wide in the picture
    for (const Vec3& p : {Vec3(-4.0, -1.5, 0.0), Vec3(4.0, -1.5, 0.0), Vec3(0.0, 4.0, 0.0)}) {
      mesh.indices.push_back(static_cast<uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(size * p - Vec3(0.0, 0.0, i * kGap));
    }
  }
  return mesh;
}

// A picture of side_px^2 that the mesh fills, lit by so many lights.
Subject subject_of(MeshData mesh, int side_px, int lights) {
  Subject out;
  out.scene.materials.resize(1);
  out.scene.materials[0].specular = Color(0.3);
  out.scene.meshes.push_back(std::move(mesh));
  out.scene.objects.emplace_back().shape = MeshShape{0};
  for (int i = 0; i < lights; ++i) {
    Light& light = out.scene.lights.emplace_back();
    const double turn = 2.0 * elementary::kPi * i / lights;
    light.position = Vec3(2.0 * elementary::cos(turn), 2.0 * elementary::sin(turn), 3.0);
    light.intensity = 2.0 / lights;
  }
  out.view.image = {side_px, side_px};
  Camera& camera = out.view.camera.emplace();
  camera.position = Vec3(0.0, 0.0, kEyeDistance);
  camera.fov_y_deg = 40.0;
  RenderSpec& render = out.view.render;
  render.tessellate = true, render.shadows = false, render.max_depth = 0, render.samples = 1;
  return out;
}

// The values of a sweep, about a factor of 64 in all.
std::vector<int> doubled(int first, bool is_quick) {
  std::vector<int> out;
  for (int i = 0; i <= 6; i += is_quick ? 3 : 1) out.push_back(first << i);
  return out;
}

Sweep by_pixels(bool is_quick) {
  Sweep out{"pixels",
            "pixels",
            {{"raytrace", "b n"},
             {"zbuffer", "a + b n"},
             {"warnock", "a + b n, or less: with the edges in view"},
             {"roberts", "a + b n: ink is sampled"}},
            {}};
  for (const int side : is_quick ? std::vector{64, 128, 256} : std::vector{96, 136, 192, 272, 384, 544, 768})
    out.points.push_back({1.0 * side * side, [=] { return subject_of(waves(32), side, 1); }, {}});
  return out;
}

Sweep by_triangles(bool is_quick) {
  Sweep out{"triangles",
            "triangles, all of them in view",
            {{"raytrace", "a + b log n"},
             {"zbuffer", "a + b n"},
             {"warnock", "a + b n: all are seen"},
             {"roberts", "b n^2 of old; a + b n, an edge meeting few faces"}},
            {}};
  for (const int count : doubled(is_quick ? 512 : 8192, is_quick)) {
    const int cells = static_cast<int>(std::lround(std::sqrt(0.5 * count)));
    out.points.push_back({2.0 * cells * cells, [=] { return subject_of(waves(cells), is_quick ? 64 : 256, 1); }, {}});
  }
  return out;
}

Sweep by_depth(bool is_quick) {
  Sweep out{"depth complexity",
            "surfaces at each pixel, the farther ones first",
            {{"raytrace", "a + b log n"},
             {"zbuffer", "a + b n"},
             {"warnock", "a, with a small b n to look at each once"},
             {"roberts", "a, with a small b n"}},
            {}};
  for (const int count : doubled(is_quick ? 2 : 64, is_quick))
    out.points.push_back({1.0 * count, [=] { return subject_of(curtains(count), is_quick ? 64 : 192, 1); }, {}});
  return out;
}

Sweep by_lights(bool is_quick) {
  Sweep out{
      "lights",
      "lights",
      {{"raytrace", "a + b n"}, {"zbuffer", "a + b n"}, {"warnock", "a + b n"}, {"roberts", "a: lines know no light"}},
      {}};
  for (const int count : doubled(is_quick ? 1 : 8, is_quick))
    out.points.push_back({1.0 * count, [=] { return subject_of(waves(32), is_quick ? 64 : 192, count); }, {}});
  return out;
}

// The methods that are there: what make_method gives them is not the tracer in their place.
std::vector<Algorithm> methods(TilePool& pool) {
  const Subject s = subject_of(curtains(1), 8, 1);
  const auto scene = compile_scene(s.scene, pool);
  const auto made = [&](Algorithm algorithm) {
    View view = s.view;
    view.render.algorithm = algorithm;
    const ViewPlan plan = plan_view(*scene, view);
    const auto method = make_method(*scene, plan, pool);
    const Method& made_for_it = *method;
    return std::string(typeid(made_for_it).name());
  };
  std::vector<Algorithm> out;
  for (const auto& [algorithm, name] : kAlgorithms) {
    if (algorithm == Algorithm::raytrace || made(algorithm) != made(Algorithm::raytrace)) out.push_back(algorithm);
  }
  return out;
}

double processor_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void measure(Sweep& sweep, const std::vector<Algorithm>& algorithms, TilePool& pool, int rounds) {
  std::map<Algorithm, bool> is_over;
  for (SweepPoint& point : sweep.points) {
    const Subject subject = point.make();
    const auto compiled = compile_scene(subject.scene, pool);
    std::map<Algorithm, std::vector<double>> times;
    for (int round = 0; round < rounds; ++round) {
      for (const Algorithm algorithm : algorithms) {
        if (is_over[algorithm]) continue;
        View view = subject.view;
        view.render.algorithm = algorithm;
        const double start = processor_ms();
        Render::start(pool, Priority::normal, compiled, plan_view(*compiled, view))->wait_ms(1e12);
        times[algorithm].push_back(processor_ms() - start);
      }
    }
    for (const auto& [algorithm, ms] : times) {
      point.ms[std::string(get_word(kAlgorithms, algorithm))] = tilelight::median(ms);
      is_over[algorithm] = tilelight::median(ms) > kMostMs;
    }
  }
}

}  // namespace
}  // namespace tilelight::bench

int main(int argc, char** argv) {
  using namespace tilelight::bench;
  CLI::App app{"How the cost of every hidden-surface method grows"};
  int rounds = 7, threads = 1;
  bool is_quick = false;
  std::string json_path, svg_path = "methods.svg";
  app.add_option("--rounds", rounds, "Rounds of each measurement")->check(CLI::Range(1, 100))->capture_default_str();
  app.add_option("--threads", threads, "Threads; 0: one a core")->check(CLI::Range(0, 1024))->capture_default_str();
  app.add_option("--svg", svg_path, "Where the plots go")->capture_default_str();
  app.add_option("--json", json_path, "Where the numbers go, as JSON");
  app.add_flag("--quick", is_quick, "Small pictures, one round: that it runs");
  CLI11_PARSE(app, argc, argv);
  if (is_quick) rounds = 1;
  tilelight::TilePool pool(threads);
  const std::vector<tilelight::Algorithm> algorithms = methods(pool);
  std::vector<std::string> names;
  for (const tilelight::Algorithm a : algorithms) names.emplace_back(get_word(tilelight::kAlgorithms, a));
  std::printf("milliseconds of the processor a picture, %d threads, medians of %d rounds\n", pool.thread_count(),
              rounds);
  std::vector<Sweep> sweeps{by_pixels(is_quick), by_triangles(is_quick), by_depth(is_quick), by_lights(is_quick)};
  for (Sweep& sweep : sweeps) {
    measure(sweep, algorithms, pool, rounds);
    print_sweep(sweep, names);
    std::fflush(stdout);
  }
  std::ofstream(svg_path) << sweeps_svg(sweeps, names);
  if (!json_path.empty()) std::ofstream(json_path) << sweeps_json(sweeps, names) << "\n";
  return 0;
}
