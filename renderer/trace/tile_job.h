// SPDX-License-Identifier: Apache-2.0
// TileJob: one work item of a render, as a kernel takes it, and the choice of the kernel. The kernel traces the samples
// asked for and adds them to the film, a pixel's in index order.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>

#include "renderer/compile/compile.h"
#include "renderer/compile/compiled_scene.h"
#include "renderer/film/film.h"
#include "renderer/film/sampling.h"
#include "renderer/shade/light_equation.h"
#include "renderer/trace/eye_media.h"

namespace tilelight {

// What a work item did; summed over items in any order (integers and maxima only).
struct TileCounts {
  int64_t primary = 0, shadow = 0, reflected = 0, refracted = 0;  // rays
  int64_t nonfinite = 0;                                          // samples that were not finite, or over 1e34
  int64_t lights_on_hits = 0;    // lights that lay on the very point they should light: they bring nothing
  double untraced_weight = 0.0;  // largest weight one sample left untraced
  bool is_complete = false;      // false: cancelled on the way; the film holds part of the samples
};

// Writes down every ray of one sample, for explanations. Called in breadth-first order.
class RayListener {
 public:
  virtual ~RayListener() = default;
  struct Event {
    int depth = 0;
    const char* kind = "primary";  // primary, reflected, refracted
    Ray ray;
    Color weight{1.0};
    Hit hit;
    const Surface* surface = nullptr;  // null: a miss
    Color local{0.0};                  // ambient part, or the background
  };
  virtual void on_ray(const Event& event) = 0;
  // Follows the on_ray of its surface. visible: by channel, 0 in shadow.
  virtual void on_light(const CompiledLight& light, const LightSample& sample, const Color& visible) = 0;
};

// Samples first, first + 1, ... of every pixel of a rectangle: a cell, so that neighbours are walked together.
struct CellWork {
  TileRect rect;
  uint32_t first = 0, count = 1;
};

// What the primary rays of a work item hit, found by another method than walking them. Read by one thread.
class FirstHits {
 public:
  virtual ~FirstHits() = default;
  // Where the sample lies, as place_sample has it, and what its ray meets.
  virtual SamplePoint place(int x, int y, uint32_t sample) const = 0;
  virtual Hit at(int x, int y, uint32_t sample, const Ray& ray) const = 0;
};

struct TileJob {
  const CompiledScene* scene = nullptr;
  const ViewPlan* plan = nullptr;
  const EyeMedia* eye_media = nullptr;
  TileView* film = nullptr;  // null: nothing is written (explanations)
  std::span<const CellWork> cells;
  const std::atomic<bool>* cancelled = nullptr;  // read every batch; may be null
  TileCounts* counts = nullptr;
  const FirstHits* first_hits = nullptr;  // null: rays find them
  RayListener* listener = nullptr;        // explain() alone sets it
};

using Kernel = void (*)(const TileJob&);

Kernel kernel_of(KernelVariant variant);

// Traces one sample of every pixel of the rectangle, row by row, whatever the view's kernel is, and tells the listener
// of every ray. Nothing is written.
TileCounts explain(const CompiledScene& scene, const ViewPlan& plan, const EyeMedia& eye_media, const TileRect& rect,
                   uint32_t sample, RayListener& listener);

}  // namespace tilelight
