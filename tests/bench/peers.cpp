// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/peers.h"

#include <array>
#include <cstdio>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/bench/embree_rays.h"
#include "tests/bench/frame.h"
#include "tests/bench/timing.h"
#include "tests/bench/waves.h"

namespace tilelight::bench {
namespace {

using Json = nlohmann::ordered_json;

// What one kind of frame took, s, round by round.
struct Times {
  std::vector<double> frame, traced, single, packets, stream;

  // The best of Embree's modes that take many rays.
  std::vector<double> best() const { return median(packets) < median(stream) ? packets : stream; }
};

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
  std::printf("%-16s %9s %9s %9s %9s %9s   %-18s %-18s %s\n", "", "frame ms", "traced", "E1", "packets", "stream",
              "frame, EB/ours", "traced, EB/ours", "other hits");
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
    Times times;
    Film film(view.image.width, view.image.height);
    film.grow(1);
    for (int round = 0; round < rounds; ++round) {
      times.frame.push_back(seconds_of([&] { render_frame(*lit, lit_plan, pool, film); }));
      times.traced.push_back(trace_waves(*lit, waves, pool));
      times.single.push_back(embree.run(*jobs[0], pool));
      times.packets.push_back(embree.run(*jobs[1], pool));
      times.stream.push_back(embree.run(*jobs[2], pool));
    }
    // Their frame: our shading around their tracing.
    const std::vector<double> best = times.best();
    std::vector<double> their_frame;
    for (size_t i = 0; i < best.size(); ++i) their_frame.push_back(times.frame[i] - times.traced[i] + best[i]);
    const Ratio whole = ratio_of(their_frame, times.frame), traced = ratio_of(best, times.traced);
    const double others = embree.differing(*jobs[1], *scene, waves);
    const auto ms = [](const std::vector<double>& s) { return 1e3 * median(s); };
    std::printf("%-16s %9.1f %9.1f %9.1f %9.1f %9.1f   %.2f (%.2f - %.2f) %.2f (%.2f - %.2f)  %.4f%%\n", kind.name,
                ms(times.frame), ms(times.traced), ms(times.single), ms(times.packets), ms(times.stream), whole.middle,
                whole.least, whole.most, traced.middle, traced.least, traced.most, others);
    for (const WaveKind& of : kinds_of(waves))
      std::printf("    %-16s %8.2f Mrays\n", of.name().c_str(), 1e-6 * static_cast<double>(of.rays));
    rows.push_back({{"frame", kind.name},
                    {"frame_ms", ms(times.frame)},
                    {"traced_ms", ms(times.traced)},
                    {"embree_single_ms", ms(times.single)},
                    {"embree_packets_ms", ms(times.packets)},
                    {"embree_stream_ms", ms(times.stream)},
                    {"frame_ratio", {whole.least, whole.middle, whole.most}},
                    {"traced_ratio", {traced.least, traced.middle, traced.most}}});
  }
  return Json{{"scene", name}, {"triangles", plan.plan.triangles_instanced}, {"rows", rows}}.dump();
}

}  // namespace tilelight::bench
