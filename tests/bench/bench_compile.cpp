// SPDX-License-Identifier: Apache-2.0
// bench_compile: how long the scene's tree takes to build and how many bytes a triangle it has, beside Embree's of
// medium quality on the same triangles where that is installed, built in turn; and what compiling the document takes as
// a whole. At last what a scene of one sphere and one light costs: to compile, and to trace through a tree of one leaf
// beside calls of the sphere's test.
#include <cstdio>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "renderer/compile/compiled_scene.h"
#include "renderer/renderer.h"
#include "renderer/trace/trace_rays.h"
#include "tests/bench/bench_scene.h"
#include "tests/bench/timing.h"
#if TILELIGHT_WITH_EMBREE
#include "tests/bench/embree_rays.h"
#endif

namespace tilelight::bench {
namespace {

void print_scene(char size, TilePool& pool, int rounds) {
  const ParsedScene parsed = parse_scene(bench_scene(detail_of(size)), Limits{}).value();
  std::shared_ptr<const CompiledScene> scene;
  std::vector<double> whole_s, ours_s, theirs_s;
  double our_bytes = 0.0, their_bytes = 0.0;
  for (int i = 0; i < rounds; ++i) {
    whole_s.push_back(seconds_of([&] { scene = compile_scene(parsed.scene, pool); }));
    ours_s.push_back(
        seconds_of([&] { our_bytes = static_cast<double>(build_scene_tree(*scene, pool).memory_bytes()); }));
#if TILELIGHT_WITH_EMBREE
    const EmbreeTracer embree(*scene, pool.thread_count(), false);
    theirs_s.push_back(1e-3 * embree.build_ms());
    their_bytes = static_cast<double>(embree.memory_bytes());
#endif
  }
  const auto triangles = static_cast<double>(scene->plan.triangles_instanced);
  std::printf("%c %10.0f %12.1f %10.1f %12.1f", size, triangles, 1e3 * median(whole_s), 1e3 * median(ours_s),
              our_bytes / triangles);
  if (!theirs_s.empty()) {
    const Ratio ratio = ratio_of(ours_s, theirs_s);
    std::printf(" %11.1f %12.1f   %.2f (%.2f - %.2f)", 1e3 * median(theirs_s), their_bytes / triangles, ratio.middle,
                ratio.least, ratio.most);
  }
  std::printf("\n");
}

void print_smallest(TilePool& pool) {
  Scene document;
  document.materials.emplace_back();
  document.objects.emplace_back().shape = SphereShape{Vec3(0.0), 1.0};
  document.lights.emplace_back();
  constexpr int kRays = 4096, kRounds = 200;
  std::vector<BoundedRay> rays(kRays);
  for (int i = 0; i < kRays; ++i) {
    const Vec3 eye(0.0, 0.0, 4.0), at((i % 64 - 31.5) / 24.0, (i / 64 - 31.5) / 24.0, 0.0);
    Ray& ray = rays[static_cast<size_t>(i)].ray;
    ray.origin = eye, ray.direction = glm::normalize(at - eye);
  }
  std::vector<Hit> hits(kRays);
  std::shared_ptr<const CompiledScene> scene;
  std::vector<double> compile_s, tree_s, alone_s;
  for (int i = 0; i < kRounds; ++i) {
    compile_s.push_back(seconds_of([&] { scene = compile_scene(document, pool); }));
    tree_s.push_back(seconds_of([&] { trace_closest(*scene, rays, hits); }));
    alone_s.push_back(seconds_of([&] {
      for (size_t k = 0; k < rays.size(); ++k) hits[k] = trace_body(*scene, 0, rays[k].ray);
    }));
  }
  std::printf("one sphere: compiled in %.4f ms; %.1f ns a ray through the tree, %.1f ns by calls of its test\n",
              1e3 * median(compile_s), 1e9 * median(tree_s) / kRays, 1e9 * median(alone_s) / kRays);
}

}  // namespace
}  // namespace tilelight::bench

int main(int argc, char** argv) {
  CLI::App app{"How long trees take to build, and what they weigh"};
  std::string scenes = "sm";
  int rounds = 5, threads = 0;
  app.add_option("--scenes", scenes, "s, m, l (about 63,000, 670,000, 6.6 million triangles)")->capture_default_str();
  app.add_option("--rounds", rounds, "Rounds of each measurement")->check(CLI::Range(1, 100))->capture_default_str();
  app.add_option("--threads", threads, "Threads; 0: one a core")->check(CLI::Range(0, 1024))->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  using namespace tilelight;
  TilePool pool(threads);
  std::printf("%d threads, medians of %d rounds\n", pool.thread_count(), rounds);
  std::printf("%-2s%10s %12s %10s %12s %11s %12s   %s\n", "", "triangles", "compile ms", "tree ms", "bytes each",
              "Embree ms", "bytes each", "ours / Embree");
  // From a thread of the pool, so that no more threads work than that.
  pool.submit(Priority::normal,
              [&] {
                for (const char size : scenes) bench::print_scene(size, pool, rounds);
                bench::print_smallest(pool);
              })
      .get();
  return 0;
}
