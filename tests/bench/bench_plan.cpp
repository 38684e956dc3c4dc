// SPDX-License-Identifier: Apache-2.0
// bench_plan: what leaving out saves. Every scene, and what is left of it without glass, mirrors and shadows, is
// rendered by the kernel that its plan chose and by those that can do more, in turn; the bytes have to be equal.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "renderer/renderer.h"
#include "tests/bench/timing.h"

namespace tilelight::bench {
namespace {

// What is taken from a scene before it is planned.
struct Without {
  const char* name;
  bool glass = false, mirrors = false, shadows = false;
};
constexpr Without kWithout[] = {
    {""},
    {"no glass", true},
    {"no glass, no shadows", true, false, true},
    {"local", true, true},
    {"local, no shadows", true, true, true},
};

ParsedScene take_away(ParsedScene document, const Without& without) {
  for (Material& m : document.scene.materials) {
    if (without.glass) m.transmission = Color(0.0);
    if (without.mirrors) m.reflection = Color(0.0);
  }
  for (Light& light : document.scene.lights) light.shadow &= !without.shadows;
  document.view.image.width /= 2, document.view.image.height /= 2;
  document.view.render.samples = 1;
  document.view.render.time_ms.reset();
  document.view.render.passes.clear();
  return document;
}

// More able kernels that differ from the chosen one by mirrors or glass.
std::vector<KernelVariant> more_able_than(const ViewPlan& plan) {
  std::vector<KernelVariant> out;
  for (const Feature feature : {Feature::reflection, Feature::transmission}) {
    FeatureSet more = plan.features;
    more.add(feature);
    const KernelVariant variant = choose_variant(more);
    if (variant != plan.variant && (out.empty() || out.back() != variant)) out.push_back(variant);
  }
  return out;
}

class Bench {
 public:
  Bench(TilePool& pool, int rounds) : pool_(pool), rounds_(rounds) {}

  // False if it cannot be read, or if images differ.
  bool print_scene(const std::string& path) {
    std::ifstream file(path);
    const auto parsed = parse_scene(std::string{std::istreambuf_iterator<char>(file), {}}, Limits{});
    if (!parsed) {
      std::fprintf(stderr, "bench_plan: %s: %s\n", path.c_str(), parsed.error().errors[0].detail.c_str());
      return false;
    }
    bool is_same = true;
    for (const Without& without : kWithout) {
      const ParsedScene document = take_away(*parsed, without);
      const auto scene = compile_scene(document.scene, pool_);
      const ViewPlan chosen = plan_view(*scene, document.view);
      for (const KernelVariant variant : more_able_than(chosen)) {
        ViewPlan other = chosen;
        other.variant = variant;
        is_same &= print_pair(std::filesystem::path(path).stem().string(), without.name, scene, chosen, other);
      }
    }
    return is_same;
  }

  void print_sums() const {
    std::printf("\n%-18s %-18s %s\n", "chosen", "more able", "its time over that of the chosen one, median");
    for (const auto& [kernels, ratios] : ratios_)
      std::printf("%-18s %-18s %.3f of %zu\n", std::string(variant_name(kernels.first)).c_str(),
                  std::string(variant_name(kernels.second)).c_str(), median(ratios), ratios.size());
  }

 private:
  double seconds(const std::shared_ptr<const CompiledScene>& scene, const ViewPlan& plan, std::vector<float>& image) {
    return seconds_of([&] {
      const auto render = Render::start(pool_, Priority::normal, scene, plan);
      render->wait_ms(1e12);
      image = render->image()->rgb;
    });
  }

  bool print_pair(const std::string& name, const char* without, const std::shared_ptr<const CompiledScene>& scene,
                  const ViewPlan& chosen, const ViewPlan& other) {
    std::vector<float> images[2];
    std::vector<double> chosen_s, other_s;
    for (int i = 0; i < rounds_; ++i) {
      chosen_s.push_back(seconds(scene, chosen, images[0]));
      other_s.push_back(seconds(scene, other, images[1]));
      ratios_[{chosen.variant, other.variant}].push_back(other_s.back() / chosen_s.back());
    }
    const Ratio ratio = ratio_of(other_s, chosen_s);
    const bool is_same = images[0] == images[1];
    std::printf("%-12s %-21s %-16s %-16s %8.1f %8.1f   %.2f (%.2f - %.2f)%s\n", name.c_str(), without,
                std::string(variant_name(chosen.variant)).c_str(), std::string(variant_name(other.variant)).c_str(),
                1e3 * median(chosen_s), 1e3 * median(other_s), ratio.middle, ratio.least, ratio.most,
                is_same ? "" : "   THE IMAGES DIFFER");
    return is_same;
  }

  TilePool& pool_;
  const int rounds_;
  std::map<std::pair<KernelVariant, KernelVariant>, std::vector<double>> ratios_;
};

}  // namespace
}  // namespace tilelight::bench

int main(int argc, char** argv) {
  CLI::App app{"What leaving out saves: the chosen kernel beside those that can do more"};
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
  std::printf("%d threads, 1 sample a pixel, half the size, medians of %d rounds\n", pool.thread_count(), rounds);
  std::printf("%-12s %-21s %-16s %-16s %8s %8s   %s\n", "scene", "without", "chosen", "more able", "ms", "ms",
              "more able / chosen");
  tilelight::bench::Bench bench(pool, rounds);
  bool is_same = true;
  for (const std::string& path : paths) is_same &= bench.print_scene(path);
  bench.print_sums();
  return is_same ? 0 : 1;
}
