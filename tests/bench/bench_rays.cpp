// SPDX-License-Identifier: Apache-2.0
// bench_rays: rays a second for primary rays, shadow rays and whole frames of a scene, each beside the same work on the
// plainest instruction set, and where the time of one request goes. Figures are medians of several rounds, the two
// sides of a ratio taken in turn.
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "renderer/renderer.h"
#include "renderer/shade/light_equation.h"
#include "renderer/shade/surface.h"
#include "renderer/trace/isa.h"
#include "renderer/trace/trace_rays.h"
#include "tests/bench/bench_scene.h"
#include "tests/bench/naive_rays.h"
#include "tests/bench/textbook.h"
#include "tests/bench/timing.h"
#include "tests/bench/waves.h"
#if TILELIGHT_WITH_EMBREE
#include "tests/bench/embree_rays.h"
#include "tests/bench/machine.h"
#include "tests/bench/peers.h"
#endif

namespace tilelight {
namespace {

using bench::median, bench::seconds_of;

// Rays that are asked for together.
using Batches = std::vector<std::vector<BoundedRay>>;

Batches shadow_rays(const CompiledScene& scene, const Batches& primary) {
  Batches batches;
  for (const auto& rays : primary) {
    std::vector<Hit> hits(rays.size());
    trace_closest(scene, rays, hits);
    for (const CompiledLight& light : scene.lights) {
      if (!light.shadow) continue;
      auto& out = batches.emplace_back();
      for (size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].is_hit()) continue;
        const Surface surface = make_surface(scene, rays[i].ray, hits[i]);
        const bool is_smooth = surface.body->mesh && !surface.body->mesh->corner_normals.empty();
        const LightSample sample = sample_light(scene, light, surface, -rays[i].ray.direction, is_smooth);
        if (sample.is_lit) out.push_back({{surface.position, sample.to_light, surface.here}, sample.distance});
      }
    }
  }
  return batches;
}

// From a thread of the pool, so that no more threads work than that.
void for_each_batch(TilePool& pool, const Batches& batches,
                    const std::function<void(const std::vector<BoundedRay>&)>& work) {
  pool.submit(Priority::normal,
              [&] {
                pool.parallel_for(static_cast<int64_t>(batches.size()), Priority::normal,
                                  [&](int64_t i) { work(batches[static_cast<size_t>(i)]); });
              })
      .get();
}

int64_t count(const Batches& batches) {
  int64_t n = 0;
  for (const auto& b : batches) n += static_cast<int64_t>(b.size());
  return n;
}

struct Row {
  const char* name;
  int64_t rays = 0;
  std::function<void()> work;
};

// Rounds of best, plain, best, plain, ...: the ratio holds when the machine's speed drifts.
void print_row(const Row& row, int rounds, const std::string& plain) {
  std::vector<double> best_s, plain_s, ratio;
  for (int i = 0; i < rounds; ++i) {
    (void)select_isa("auto");
    best_s.push_back(seconds_of(row.work));
    (void)select_isa(plain);
    plain_s.push_back(seconds_of(row.work));
    ratio.push_back(plain_s.back() / best_s.back());
  }
  (void)select_isa("auto");
  const double mrays = static_cast<double>(row.rays) * 1e-6;
  std::printf("%-14s %9.2f %10.1f %12.2f %16.2f %9.2fx\n", row.name, mrays, 1e3 * median(best_s),
              mrays / median(best_s), mrays / median(plain_s), median(ratio));
}

// What exactness costs: ours, naive, ours, naive, ... on the same rays of the same scene; and how many answers the
// naive kernels get wrong.
void print_robustness(const CompiledScene& scene, const Batches& primary, const Batches& shadow, TilePool& pool,
                      int rounds) {
  const auto each = [&](const Batches& batches, const std::function<void(const std::vector<BoundedRay>&)>& trace) {
    for_each_batch(pool, batches, trace);
  };
  const auto closest = [&](auto trace) {
    return [&, trace](const std::vector<BoundedRay>& rays) {
      std::vector<Hit> hits(rays.size());
      trace(scene, rays, hits);
    };
  };
  const auto any = [&](auto trace) {
    return [&, trace](const std::vector<BoundedRay>& rays) {
      std::vector<uint8_t> is_blocked(rays.size());
      trace(scene, rays, is_blocked);
    };
  };
  std::atomic<int64_t> wrong_ids = 0, wrong_shadows = 0, left_primary = 0, left_shadow = 0;
  each(primary, [&](const std::vector<BoundedRay>& rays) {
    std::vector<Hit> ours(rays.size()), naive(rays.size());
    trace_closest(scene, rays, ours);
    naive_closest(scene, rays, naive);
    for (size_t i = 0; i < rays.size(); ++i)
      wrong_ids += ours[i].body != naive[i].body || ours[i].prim != naive[i].prim;
    left_primary += undecided_of(scene, rays).closest;
  });
  each(shadow, [&](const std::vector<BoundedRay>& rays) {
    std::vector<uint8_t> ours(rays.size()), naive(rays.size());
    trace_any(scene, rays, ours);
    naive_any(scene, rays, naive);
    for (size_t i = 0; i < rays.size(); ++i) wrong_shadows += ours[i] != naive[i];
    left_shadow += undecided_of(scene, rays).any;
  });
  std::printf("\n%-14s %12s %16s %18s %14s %18s\n", "robustness", "ours ms", "naive float ms", "ours over naive",
              "naive wrong", "ours one by one");
  const auto row = [&](const char* name, const Batches& batches, const auto& ours, const auto& naive, int64_t wrong,
                       int64_t left) {
    std::vector<double> ours_s, naive_s, ratio;
    for (int i = 0; i < rounds; ++i) {
      ours_s.push_back(seconds_of([&] { each(batches, ours); }));
      naive_s.push_back(seconds_of([&] { each(batches, naive); }));
      ratio.push_back(ours_s.back() / naive_s.back());
    }
    const auto part = [&](int64_t of) {
      return 100.0 * static_cast<double>(of) / static_cast<double>(std::max<int64_t>(1, count(batches)));
    };
    std::printf("%-14s %12.1f %16.1f %17.2fx %13.4f%% %17.2f%%\n", name, 1e3 * median(ours_s), 1e3 * median(naive_s),
                median(ratio), part(wrong), part(left));
  };
  row("primary", primary, closest(trace_closest), closest(naive_closest), wrong_ids, left_primary);
  row("shadow", shadow, any(trace_any), any(naive_any), wrong_shadows, left_shadow);
}

struct Stage {
  const char* name;
  double ms;
};

void print_stages(const std::vector<Stage>& stages) {
  double total = 0.0;
  for (const Stage& s : stages) total += s.ms;
  std::printf("\n%-14s %10s %8s\n", "stage", "ms", "share");
  for (const Stage& s : stages) std::printf("%-14s %10.2f %7.1f%%\n", s.name, s.ms, 100.0 * s.ms / total);
  std::printf("%-14s %10.2f\n", "request", total);
}

int run(const std::string& path, int rounds, int threads, bool robustness) {
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  TilePool pool(threads);

  std::vector<Stage> stages;
  const auto stage = [&](const char* name, const std::function<void()>& work) {
    stages.push_back({name, 1e3 * seconds_of(work)});
  };
  tl::expected<ParsedScene, SceneErrors> parsed;
  stage("parse", [&] { parsed = parse_scene(text, Limits{}); });
  if (!parsed) {
    std::fprintf(stderr, "%s: %s\n", path.c_str(),
                 parsed.error().errors.empty() ? "cannot be read" : parsed.error().errors[0].detail.c_str());
    return 1;
  }
  View view = parsed->view;
  view.render.samples = 1;
  view.render.time_ms.reset();
  view.render.passes.clear();
  std::shared_ptr<const CompiledScene> scene;
  ViewPlan plan;
  stage("compile", [&] { scene = compile_scene(parsed->scene, pool); });
  stage("plan", [&] { plan = plan_view(*scene, view); });
  std::shared_ptr<Render> render;
  const auto render_frame = [&] {
    render = Render::start(pool, Priority::normal, scene, plan);
    render->wait_ms(1e12);
  };
  stage("render", render_frame);
  Result<std::string> png;
  stage("encode", [&] { png = encode_image(*render->image(), view.image.exposure, ImageFormat::png); });

  const std::string plain = available_isas().back();
  std::printf("%s, %dx%d, 1 sample a pixel, %lld triangles, kernel %s, %s, %d threads; median of %d rounds\n\n",
              path.c_str(), view.image.width, view.image.height, static_cast<long long>(plan.plan.triangles_instanced),
              plan.plan.kernel.c_str(), plan.plan.isa.c_str(), pool.thread_count(), rounds);
  std::printf("%-14s %9s %10s %12s %16s %10s\n", "rays", "Mrays", "ms", "Mrays/s", ("on " + plain).c_str(), "ratio");
  const Batches primary = bench::primary_rays(plan);
  const Batches shadow = shadow_rays(*scene, primary);
  if (robustness) {
    print_robustness(*scene, primary, shadow, pool, rounds);
    return 0;
  }
  print_row({"primary", count(primary),
             [&] {
               for_each_batch(pool, primary, [&](const std::vector<BoundedRay>& rays) {
                 std::vector<Hit> hits(rays.size());
                 trace_closest(*scene, rays, hits);
               });
             }},
            rounds, plain);
  print_row({"shadow", count(shadow),
             [&] {
               for_each_batch(pool, shadow, [&](const std::vector<BoundedRay>& rays) {
                 std::vector<uint8_t> is_blocked(rays.size());
                 trace_any(*scene, rays, is_blocked);
               });
             }},
            rounds, plain);
  print_row({"whole frame", render->report().points.back().rays.total(), render_frame}, rounds, plain);
  print_stages(stages);
  return 0;
}

struct PeerArguments {
  std::string name, scenes = "sml", json_path;  // name: empty beside the textbook
  int rounds = 5;
  bool is_robust = false, as_markdown = false;
};

// The bench scenes, by another tracer too. From a thread of the pool, so that a loop over tiles has no more threads
// than that.
int run_beside(const PeerArguments& arguments, int threads) {
  TilePool pool(threads);
  std::vector<std::string> lines;  // JSON, one a scene
  std::string markdown;
  pool.submit(Priority::normal,
              [&] {
#if TILELIGHT_WITH_EMBREE
                std::FILE* const log = arguments.as_markdown ? stderr : stdout;
                std::vector<bench::PeerFigures> figures;
                if (!arguments.name.empty())
                  std::fprintf(log, "%s, %s\n", bench::machine_name().c_str(), bench::embree_build().c_str());
#endif
                for (const char size : arguments.scenes) {
                  const std::string name(1, size), document = bench::bench_scene(bench::detail_of(size));
                  if (arguments.name.empty())
                    lines.push_back(bench::compare_with_textbook(name, document, pool, arguments.rounds));
#if TILELIGHT_WITH_EMBREE
                  if (arguments.name.empty()) continue;
                  figures.push_back(
                      bench::compare_with_embree(name, document, pool, arguments.rounds, arguments.is_robust, log));
                  lines.push_back(bench::peer_json(figures.back()));
#endif
                }
#if TILELIGHT_WITH_EMBREE
                if (arguments.as_markdown)
                  markdown = bench::peer_markdown(figures, pool.thread_count(), arguments.rounds, arguments.is_robust);
#endif
              })
      .get();
  std::fputs(markdown.c_str(), stdout);
  if (arguments.json_path.empty()) return 0;
  std::ofstream json(arguments.json_path);
  for (const std::string& line : lines) json << line << "\n";
  if (json.flush()) return 0;
  std::fprintf(stderr, "bench_rays: cannot write %s\n", arguments.json_path.c_str());
  return 1;
}

// For the command line: empty if every letter is a scene.
std::string is_bench_scenes(const std::string& scenes) {
  const bool is_known = !scenes.empty() && scenes.find_first_not_of("sml") == std::string::npos;
  return is_known ? "" : "found '" + scenes + "'; allowed: letters of s, m, l";
}

}  // namespace
}  // namespace tilelight

int main(int argc, char** argv) {
  using namespace tilelight;
  CLI::App app{"Rays a second of the fast renderer, and where the time of a request goes"};
  std::string path = TILELIGHT_SOURCE_DIR "/web/scenes/opening.json";
  int rounds = 5, threads = 0;
  app.add_option("scene", path, "Scene file")->check(CLI::ExistingFile)->capture_default_str();
  app.add_option("--rounds", rounds, "Rounds of each measurement")->check(CLI::Range(1, 100))->capture_default_str();
  app.add_option("--threads", threads, "Threads; 0: one a core")->check(CLI::Range(0, 1024))->capture_default_str();
  bool robustness = false;
  app.add_flag("--robustness", robustness, "What exactness costs: beside float kernels without the care for numbers");
  std::string baseline;
  PeerArguments peer;
  app.add_option("--peer", peer.name, "Beside another tracer, on the bench scenes: embree")
      ->check(CLI::IsMember({"embree"}));
  app.add_option("--baseline", baseline, "Beside the way of the textbooks, on the bench scenes: textbook")
      ->check(CLI::IsMember({"textbook"}))
      ->excludes("--peer");
  app.add_option("--scenes", peer.scenes, "Which of them: s, m, l (63,000, 670,000, 6.6 million triangles)")
      ->check(is_bench_scenes)
      ->capture_default_str();
  app.add_flag("--robust-peer", peer.is_robust, "Embree's robust mode");
  app.add_flag(
         "--markdown", peer.as_markdown,
         "The figures of --peer as the table of renderer/trace/README.md on standard output; all else on standard "
         "error")
      ->needs("--peer");
  app.add_option("--json", peer.json_path,
                 "Also write the figures of --peer or --baseline to a file, one scene a line");
  CLI11_PARSE(app, argc, argv);
#if !TILELIGHT_WITH_EMBREE
  if (!peer.name.empty()) {
    std::fprintf(stderr, "bench_rays: built without Embree; install libembree-dev and configure again\n");
    return 2;
  }
#endif
  peer.rounds = rounds;
  if (!peer.name.empty() || !baseline.empty()) return tilelight::run_beside(peer, threads);
  return tilelight::run(path, rounds, threads, robustness);
}
