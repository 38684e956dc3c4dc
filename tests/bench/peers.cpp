// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/peers.h"

#include <array>
#include <cstdio>
#include <numeric>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/bench/embree_rays.h"
#include "tests/bench/frame.h"
#include "tests/bench/machine.h"
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

double ms(const std::vector<double>& seconds) { return 1e3 * median(seconds); }

struct Kind {
  const char* name;
  int max_depth;
  size_t shadow_lights;  // so many cast shadows; the rest of them light without
};

PeerFigures::Frame compare_frame(const Kind& kind, const ParsedScene& parsed, const EmbreeTracer& embree,
                                 TilePool& pool, int rounds, std::FILE* log) {
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
  const PeerFigures::Frame out{kind.name,
                               ms(frame),
                               ms(traced),
                               ms(sums(modes[0])),
                               ms(sums(modes[1])),
                               ms(sums(modes[2])),
                               ms(best),
                               ratio_of(their_frame, frame),
                               ratio_of(best, traced)};
  std::fprintf(log, "%-12s %8.1f %8.1f %8.1f %8.1f %8.1f %8.1f   %.2f (%.2f - %.2f) %.2f (%.2f - %.2f)  %.4f%%\n",
               kind.name, out.frame_ms, out.traced_ms, out.single_ms, out.packets_ms, out.stream_ms, out.best_ms,
               out.whole.middle, out.whole.least, out.whole.most, out.alone.middle, out.alone.least, out.alone.most,
               embree.differing(*jobs[1], *lit, waves));
  for (const WaveKind& of : kinds_of(waves))
    std::fprintf(log, "    %-16s %8.2f Mrays\n", of.name().c_str(), 1e-6 * static_cast<double>(of.rays));
  return out;
}

}  // namespace

PeerFigures compare_with_embree(const std::string& name, const std::string& document, TilePool& pool, int rounds,
                                bool robust, std::FILE* log) {
  const ParsedScene parsed = parse_scene(document, Limits{}).value();
  std::shared_ptr<const CompiledScene> scene;
  const double compile_s = seconds_of([&] { scene = compile_scene(parsed.scene, pool); });
  PeerFigures out{name, plan_view(*scene, parsed.view).plan.triangles_instanced, {}};
  const EmbreeTracer embree(*scene, pool.thread_count(), robust);
  std::fprintf(
      log,
      "\n%s: %lld triangles; compiled in %.0f ms, Embree's tree alone (medium, %.1f bytes a triangle) in %.0f ms\n",
      name.c_str(), static_cast<long long>(out.triangles), 1e3 * compile_s,
      static_cast<double>(embree.memory_bytes()) / static_cast<double>(out.triangles), embree.build_ms());
  std::fprintf(log, "%-12s %8s %8s %8s %8s %8s %8s   %-18s %-18s %s\n", "", "frame ms", "traced", "single", "packets",
               "stream", "EB, best", "frame, EB/ours", "traced, EB/ours", "other hits");
  for (const Kind& kind : {Kind{"primary", 0, 0}, Kind{"+ 1 shadow", 0, 1}, Kind{"Whitted", 3, 2}})
    out.frames.push_back(compare_frame(kind, parsed, embree, pool, rounds, log));
  return out;
}

std::string peer_json(const PeerFigures& figures) {
  Json rows = Json::array();
  for (const PeerFigures::Frame& frame : figures.frames) {
    rows.push_back({{"frame", frame.name},
                    {"frame_ms", frame.frame_ms},
                    {"traced_ms", frame.traced_ms},
                    {"embree_single_ms", frame.single_ms},
                    {"embree_packets_ms", frame.packets_ms},
                    {"embree_stream_ms", frame.stream_ms},
                    {"embree_best_ms", frame.best_ms},
                    {"frame_ratio", {frame.whole.least, frame.whole.middle, frame.whole.most}},
                    {"traced_ratio", {frame.alone.least, frame.alone.middle, frame.alone.most}}});
  }
  return Json{{"scene", figures.scene},
              {"triangles", figures.triangles},
              {"machine", machine_name()},
              {"peer", embree_build()},
              {"rows", rows}}
      .dump();
}

std::string peer_markdown(const std::vector<PeerFigures>& scenes, int threads, int rounds, bool robust) {
  std::string out = machine_name() + "; " + std::to_string(threads) + (threads == 1 ? " thread; " : " threads; ") +
                    embree_build() + (robust ? ", robust" : "") + "; medians of " + std::to_string(rounds) +
                    " rounds; " + today() + "\n\n| Embree's time over ours |";
  for (const PeerFigures& scene : scenes) out += " " + scene.scene + " |";
  out += "\n|---|";
  for (size_t i = 0; i < scenes.size(); ++i) out += "---|";
  for (const auto& [what, ratio] :
       {std::pair{"tracing alone", &PeerFigures::Frame::alone}, std::pair{"whole frame", &PeerFigures::Frame::whole}}) {
    for (size_t row = 0; row < scenes.front().frames.size(); ++row) {
      out += "\n| " + scenes.front().frames[row].name + ", " + what + " |";
      for (const PeerFigures& scene : scenes) {
        char cell[16];
        std::snprintf(cell, sizeof cell, " %.2f |", (scene.frames[row].*ratio).middle);
        out += cell;
      }
    }
  }
  return out + "\n";
}

}  // namespace tilelight::bench
