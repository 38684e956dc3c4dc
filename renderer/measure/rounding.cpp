// SPDX-License-Identifier: Apache-2.0
#include "renderer/measure/rounding.h"

#include <algorithm>
#include <cmath>

#include "renderer/base/standard_floats.h"
#include "renderer/film/tone.h"
#include "renderer/measure/reference.h"
#include "renderer/trace/pixel_filter.h"
#include "renderer/trace/tile_job.h"

namespace tilelight {
namespace {

class ColorListener : public RayListener {
 public:
  void on_ray(const Event& event) override {
    weight_ = event.weight;
    color += weight_ * event.local;
  }
  void on_light(const CompiledLight&, const LightSample& sample, const Color& visible) override {
    color += weight_ * visible * (sample.diffuse + sample.specular);
  }
  Color color{0.0};

 private:
  Color weight_{1.0};
};

}  // namespace

std::optional<double> find_rounding(const Scene& scene, const CompiledScene& compiled, const ViewPlan& plan) {
  constexpr int kAcross = 8;
  constexpr int64_t kMostTriangles = 1'000'000;
  const View& view = plan.view;
  if (is_tessellated(view.render) || scene_plan(compiled).triangles_stored > kMostTriangles) return std::nullopt;
  const StandardFloats floats;
  const EyeMedia eye_media(compiled, plan);
  const ReferenceScene twin(scene);
  const ReferenceEye eye = make_reference_eye(twin, view, plan.camera);
  double squares = 0.0;
  for (int i = 0; i < kAcross * kAcross; ++i) {
    const int x = (2 * (i % kAcross) + 1) * view.image.width / (2 * kAcross);
    const int y = (2 * (i / kAcross) + 1) * view.image.height / (2 * kAcross);
    ColorListener listener;
    explain(compiled, plan, eye_media, {x, y, x + 1, y + 1}, 0, listener);
    const SamplePoint p = place_sample(view.render, x, y, 0);
    const Color exact = reference_sample(twin, eye, {x + p.x, y + p.y}).color;
    for (int c = 0; c < 3; ++c) {
      const auto kept = static_cast<float>(listener.color[c]);  // as the film keeps it
      const double off = displayed(kept, view.image.exposure) - displayed(exact[c], view.image.exposure);
      squares += off * off;
    }
  }
  return std::sqrt(squares / (3.0 * kAcross * kAcross));
}

}  // namespace tilelight
