// SPDX-License-Identifier: Apache-2.0
// bench_plan: what leaving out saves. Every scene is rendered by the kernel that its plan chose and by the one that can
// do everything, in turn; the bytes have to be equal.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "renderer/renderer.h"
#include "tests/bench/timing.h"

namespace tilelight::bench {
namespace {

// False if the images differ.
bool print_scene(const std::string& path, TilePool& pool, int rounds) {
  std::ifstream file(path);
  const auto parsed = parse_scene(std::string{std::istreambuf_iterator<char>(file), {}}, Limits{});
  if (!parsed) {
    std::fprintf(stderr, "bench_plan: %s: %s\n", path.c_str(), parsed.error().errors[0].detail.c_str());
    return false;
  }
  View view = parsed->view;
  view.render.samples = 1;
  view.render.time_ms.reset();
  view.render.passes.clear();
  const auto scene = compile_scene(parsed->scene, pool);
  const ViewPlan chosen = plan_view(*scene, view);
  ViewPlan full = chosen;
  full.variant = KernelVariant::glass_shadows;
  std::vector<float> images[2];
  const auto seconds = [&](const ViewPlan& plan, std::vector<float>& image) {
    return seconds_of([&] {
      const auto render = Render::start(pool, Priority::normal, scene, plan);
      render->wait_ms(1e12);
      image = render->image()->rgb;
    });
  };
  std::vector<double> chosen_s, full_s;
  for (int i = 0; i < rounds; ++i) {
    chosen_s.push_back(seconds(chosen, images[0]));
    full_s.push_back(seconds(full, images[1]));
  }
  const Ratio ratio = ratio_of(full_s, chosen_s);
  const bool is_same = images[0] == images[1];
  std::printf("%-22s %-16s %10.1f %10.1f   %.2f (%.2f - %.2f)%s\n", std::filesystem::path(path).stem().c_str(),
              chosen.plan.kernel.c_str(), 1e3 * median(chosen_s), 1e3 * median(full_s), ratio.middle, ratio.least,
              ratio.most, is_same ? "" : "   THE IMAGES DIFFER");
  return is_same;
}

}  // namespace
}  // namespace tilelight::bench

int main(int argc, char** argv) {
  CLI::App app{"What leaving out saves: the chosen kernel beside the one that can do everything"};
  std::vector<std::string> paths;
  int rounds = 5, threads = 0;
  app.add_option("scenes", paths, "Scene files; else those of web/scenes")->check(CLI::ExistingFile);
  app.add_option("--rounds", rounds, "Rounds of each measurement")->check(CLI::Range(1, 100))->capture_default_str();
  app.add_option("--threads", threads, "Threads; 0: one a core")->check(CLI::Range(0, 1024))->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  if (paths.empty()) {
    for (const auto& entry : std::filesystem::directory_iterator(TILELIGHT_SOURCE_DIR "/web/scenes")) {
      if (entry.path().stem() != "index") paths.push_back(entry.path());
    }
    std::sort(paths.begin(), paths.end());
  }
  tilelight::TilePool pool(threads);
  std::printf("%d threads, 1 sample a pixel, medians of %d rounds\n", pool.thread_count(), rounds);
  std::printf("%-22s %-16s %10s %10s   %s\n", "scene", "kernel", "chosen ms", "full ms", "full / chosen");
  bool is_same = true;
  for (const std::string& path : paths) is_same &= tilelight::bench::print_scene(path, pool, rounds);
  return is_same ? 0 : 1;
}
