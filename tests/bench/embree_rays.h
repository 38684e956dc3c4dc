// SPDX-License-Identifier: Apache-2.0
// Embree 3 on the triangles of a compiled scene: all bodies in one scene, built at medium quality, the rays in its own
// layouts, converted before anything is timed.
#pragma once

#include <memory>

#include "tests/bench/waves.h"

namespace tilelight::bench {

enum class EmbreeMode { single, packets, stream };  // rtcIntersect1, rtcIntersect16, rtcIntersect1M

class EmbreeTracer {
 public:
  // REQUIRES: every body is a mesh.
  EmbreeTracer(const CompiledScene& scene, int threads, bool robust);
  ~EmbreeTracer();
  double build_ms() const;
  int64_t memory_bytes() const;

  // Takes the rays. Those before the first reflection are told to be coherent.
  class Job;
  using JobPtr = std::shared_ptr<Job>;
  JobPtr prepare(const std::vector<Wave>& waves, EmbreeMode mode) const;
  // Seconds.
  double run(Job& job, TilePool& pool) const;
  // Of the last run, in percent: hits of the first wave that are not the (body, primitive) of `hits`.
  double differing(const Job& job, const std::vector<std::vector<Hit>>& hits) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tilelight::bench
