// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/peers.h"

#include <array>
#include <cstdio>
#include <numeric>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/bench/embree_rays.h"
#include "tests/bench/frame.h"
#include "tests/bench/timing.h"
#include "tests/bench/waves.h"

namespace tilelight::bench {
namespace {

using Json = nlohmann::ordered_json;

// What one of Embree's modes took, s, by kind of rays, round by round.
using ModeTimes = std::vector<std::vector<double>>;

std::vector<double> sums(const ModeTimes& times) {
  std::vector<double> out;
  for (const auto& round : times) out.push_back(std::accumulate(round.begin(), round.end(), 0.0));
  return out;
}

// Each kind of rays by the mode that is best for it.
std::vector<double> best_of(const std::array<ModeTimes, 3>& modes) {
  const size_t rounds = modes[0].size();
  std::vector<double> out(rounds, 0.0);
  for (size_t kind = 0; kind < modes[0][0].size(); ++kind) {
    std::vector<double> best;
    for (const ModeTimes& mode : modes) {
      std::vector<double> of_kind;
      for (const auto& round : mode) of_kind.push_back(round[kind]);
      if (best.empty() || median(of_kind) < median(best)) best = of_kind;
    }
    for (size_t i = 0; i < rounds; ++i) out[i] += best[i];
  }
  return out;
}

}  // namespace

std::string compare_with_embree(const std::string& name, const std::string& document, TilePool& pool, int rounds,
                                bool robust) {
  const ParsedScene parsed = parse_scene(document, Limits{}).value();
  std::shared_ptr<const CompiledScene> scene;
  const double compile_s = seconds_of([&] { scene = compile_scene(parsed.scene, pool); });
  const ViewPlan plan = plan_view(*scene, parsed.view);
  const EmbreeTracer embree(*scene, pool.thread_count(), robust);
  std::printf(
      "\n%s: %lld triangles; compiled in %.0f ms, Embree's tree alone (medium, %.1f bytes a triangle) in %.0f ms\n",
      name.c_str(), static_cast<long long>(plan.plan.triangles_instanced), 1e3 * compile_s,
      static_cast<double>(embree.memory_bytes()) / static_cast<double>(plan.plan.triangles_instanced),
      embree.build_ms());
  std::printf("%-12s %8s %8s %8s %8s %8s %8s   %-18s %-18s %s\n", "", "frame ms", "traced", "single", "packets",
              "stream", "EB, best", "frame, EB/ours", "traced, EB/ours", "other hits");
  struct Kind {
    const char* name;
    int max_depth;
    size_t shadow_lights;  // so many cast shadows; the rest of them light without
  };
  Json rows = Json::array();
  for (const Kind& kind : {Kind{"primary", 0, 0}, Kind{"+ 1 shadow", 0, 1}, Kind{"Whitted", 3, 2}}) {
    Scene of_kind = parsed.scene;
    for (size_t i = 0; i < of_kind.lights.size(); ++i) of_kind.lights[i].shadow = i < kind.shadow_lights;
    View view = parsed.view;
    view.render.max_depth = kind.max_depth;
    const auto lit = compile_scene(of_kind, pool);
    const ViewPlan lit_plan = plan_view(*lit, view);
    const FrameWaves waves = waves_of(*lit, lit_plan, pool);
    const std::array jobs = {embree.prepare(waves, EmbreeMode::single), embree.prepare(waves, EmbreeMode::packets),
                             embree.prepare(waves, EmbreeMode::stream)};
    std::vector<double> frame, traced;
    std::array<ModeTimes, 3> modes;
    Film film(view.image.width, view.image.height);
    film.grow(1);
    for (int round = 0; round < rounds; ++round) {
      frame.push_back(seconds_of([&] { render_frame(*lit, lit_plan, pool, film); }));
      traced.push_back(trace_waves(*lit, waves, pool));
      for (size_t mode = 0; mode < jobs.size(); ++mode) modes[mode].push_back(embree.run(*jobs[mode], pool));
    }
    const std::vector<double> best = best_of(modes);
    std::vector<double> their_frame;  // reckoned: our frame with their tracing in place of ours
    for (size_t i = 0; i < best.size(); ++i) their_frame.push_back(frame[i] - traced[i] + best[i]);
    const Ratio whole = ratio_of(their_frame, frame), alone = ratio_of(best, traced);
    const double others = embree.differing(*jobs[1], *scene, waves);
    const auto ms = [](const std::vector<double>& s) { return 1e3 * median(s); };
    std::printf("%-12s %8.1f %8.1f %8.1f %8.1f %8.1f %8.1f   %.2f (%.2f - %.2f) %.2f (%.2f - %.2f)  %.4f%%\n",
                kind.name, ms(frame), ms(traced), ms(sums(modes[0])), ms(sums(modes[1])), ms(sums(modes[2])), ms(best),
                whole.middle, whole.least, whole.most, alone.middle, alone.least, alone.most, others);
    for (const WaveKind& of : kinds_of(waves))
      std::printf("    %-16s %8.2f Mrays\n", of.name().c_str(), 1e-6 * static_cast<double>(of.rays));
    rows.push_back({{"frame", kind.name},
                    {"frame_ms", ms(frame)},
                    {"traced_ms", ms(traced)},
                    {"embree_single_ms", ms(sums(modes[0]))},
                    {"embree_packets_ms", ms(sums(modes[1]))},
                    {"embree_stream_ms", ms(sums(modes[2]))},
                    {"embree_best_ms", ms(best)},
                    {"frame_ratio", {whole.least, whole.middle, whole.most}},
                    {"traced_ratio", {alone.least, alone.middle, alone.most}}});
  }
  return Json{{"scene", name}, {"triangles", plan.plan.triangles_instanced}, {"rows", rows}}.dump();
}

}  // namespace tilelight::bench
