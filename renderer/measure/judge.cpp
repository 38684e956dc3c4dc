// SPDX-License-Identifier: Apache-2.0
#include "renderer/measure/judge.h"

#include <chrono>
#include <utility>

#include "renderer/film/tone.h"
#include "renderer/render/render.h"
#include "renderer/trace/primary_ids.h"

namespace tilelight {
namespace {

class Stopwatch {
 public:
  double ms() const { return std::chrono::duration<double, std::milli>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace

Verdict judge_view(const Scene& scene, View view, TilePool& pool) {
  view.render.samples = 1;
  view.render.time_ms.reset();
  view.render.passes.clear();
  Verdict verdict;
  verdict.width = view.image.width, verdict.height = view.image.height;

  const auto compiled = compile_scene(scene, pool);
  const ViewPlan plan = plan_view(*compiled, view);
  const Stopwatch fast_watch;
  const auto render = Render::start(pool, Priority::normal, compiled, plan);
  while (!render->wait_ms(1e9)) continue;
  verdict.fast_ms = fast_watch.ms();
  verdict.fast_nonfinite = render->report().points.back().nonfinite;
  verdict.fast = {to_srgb8(*render->image(), view.image.exposure), primary_ids(*compiled, plan)};

  const ReferenceScene reference(scene);
  const Stopwatch reference_watch;
  verdict.reference = reference_image(reference, view, plan.camera, pool);
  verdict.reference_ms = reference_watch.ms();
  verdict.shown_reference = shown_image(verdict.reference, view.image.width, view.image.height, view.image.exposure);
  verdict.difference = compare_images(verdict.fast, verdict.shown_reference, verdict.reference);
  return verdict;
}

}  // namespace tilelight
