// SPDX-License-Identifier: Apache-2.0
// bench_rays --peer embree: our tracer and Embree's in turn, on identical triangles and rays.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "renderer/schedule/tile_pool.h"
#include "tests/bench/timing.h"

namespace tilelight::bench {

// Of one scene, Embree's time over ours.
struct PeerFigures {
  struct Frame {
    std::string name;
    double frame_ms = 0.0, traced_ms = 0.0;
    double single_ms = 0.0, packets_ms = 0.0, stream_ms = 0.0, best_ms = 0.0;  // Embree's
    Ratio whole{}, alone{};  // of the frame with Embree's tracing in place of ours; of tracing alone
  };
  std::string scene;
  int64_t triangles = 0;
  std::vector<Frame> frames;
};

// Prints a table for the scene to `log`.
PeerFigures compare_with_embree(const std::string& name, const std::string& document, TilePool& pool, int rounds,
                                bool robust, std::FILE* log);

std::string peer_json(const PeerFigures& figures);

// The figures of all scenes as a table in Markdown, beneath the machine, the threads, the Embree and the day.
std::string peer_markdown(const std::vector<PeerFigures>& scenes, int threads, int rounds, bool robust);

}  // namespace tilelight::bench
