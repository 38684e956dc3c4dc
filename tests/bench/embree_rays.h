// SPDX-License-Identifier: Apache-2.0
// Embree 3 on the triangles of a compiled scene: all bodies in one scene, built at medium quality, the rays in its own
// layouts, converted before anything is timed and copied to the cache before they are traced, as ours are.
#pragma once

#include <memory>
#include <string>

#include "tests/bench/waves.h"

namespace tilelight::bench {

enum class EmbreeMode { single, packets, stream };  // rtcIntersect1, rtcIntersect16, rtcIntersect1M

// Which Embree was met: its version, and what of its build costs time: "Embree 3.13.5 (ray masks on, assertions on)".
// Ray masks are a property of the device; assertions show by what the library imports.
std::string embree_build();

// All calls that are timed run with denormal numbers as zero, as Embree's manual asks; ours never do.
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
  JobPtr prepare(const FrameWaves& frame, EmbreeMode mode) const;
  // Seconds that a thread of the pool took on average, by kind of rays as kinds_of has them.
  std::vector<double> run(const Job& job, TilePool& pool) const;
  // In percent: primary rays that do not hit the (body, primitive) that ours do.
  double differing(const Job& job, const CompiledScene& scene, const FrameWaves& frame) const;

 private:
  struct State;
  struct Layout;
  struct Part;
  void trace(const Job& job, const Part& part, Layout& now) const;

  std::unique_ptr<State> state_;
};

}  // namespace tilelight::bench
