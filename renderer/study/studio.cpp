// SPDX-License-Identifier: Apache-2.0
#include "renderer/study/studio.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tilelight::study {

Drawing Studio::draw(const std::shared_ptr<const CompiledScene>& scene, const View& view) const {
  stop_if_cancelled();
  const auto render = Render::start(pool_, Priority::normal, scene, plan_view(*scene, view));
  constexpr double kLookMs = 100.0;
  while (!render->wait_ms(kLookMs)) {
    if (options_.is_cancelled && options_.is_cancelled()) render->cancel();
  }
  stop_if_cancelled();
  const RenderProgress progress = render->progress();
  if (progress.state != RenderState::done) throw std::runtime_error("a render failed: " + progress.error);
  const ReportPoint end = render->report().points.back();
  return {render->image(),
          render->error_bounds(),
          progress.elapsed_ms,
          end.cpu_ms,
          end.spp,
          end.error,
          end.truncation_bound,
          end.rays};
}

std::vector<Drawing> Studio::draw_rounds(const std::shared_ptr<const CompiledScene>& scene, View view) const {
  std::vector<Drawing> out;
  for (int round = 1; round <= options_.rounds; ++round) {
    view.render.seed = static_cast<uint32_t>(round);
    out.push_back(draw(scene, view));
  }
  return out;
}

void Studio::stop_if_cancelled() const {
  if (options_.is_cancelled && options_.is_cancelled()) throw Cancelled{};
}

void Studio::tell(const std::string& what, double done) const {
  stop_if_cancelled();
  if (options_.on_progress) options_.on_progress(what, done);
}

View with_samples(View view, int samples, bool is_adaptive) {
  view.render.samples = samples;
  view.render.samples_implied = false;
  view.render.rmse.reset();
  view.render.time_ms.reset();
  view.render.passes.clear();
  view.render.adaptive = is_adaptive;
  return view;
}

void time_run(StudyRun& run, const std::vector<Drawing>& drawings) {
  std::vector<double> times, cpu_times;
  double told = 0.0;
  bool is_told = true;
  for (const Drawing& drawing : drawings) {
    times.push_back(drawing.time_ms), cpu_times.push_back(drawing.cpu_ms);
    run.spp += drawing.spp / static_cast<double>(drawings.size());
    told += drawing.told.rmse / static_cast<double>(drawings.size());
    is_told = is_told && drawing.told.is_known;
  }
  if (is_told) run.told_rmse = told;
  run.time_ms = median(times), run.cpu_ms = median(cpu_times);
  run.time_low_ms = *std::min_element(times.begin(), times.end());
  run.time_high_ms = *std::max_element(times.begin(), times.end());
}

void judge(StudyRun& run, const std::vector<Drawing>& drawings, const Image& truth, double exposure, TilePool& pool) {
  std::vector<ImageError> errors(drawings.size());
  pool.parallel_for(static_cast<int64_t>(drawings.size()), Priority::normal, [&](int64_t i) {
    errors[static_cast<size_t>(i)] = image_error(*drawings[static_cast<size_t>(i)].image, truth, exposure);
  });
  const double share = 1.0 / static_cast<double>(errors.size());
  ImageError& sum = run.error;
  double squares = 0.0;
  for (size_t i = 0; i < errors.size(); ++i) {
    const ImageError& e = errors[i];
    squares += share * e.rmse * e.rmse;
    sum.p99 += share * e.p99, sum.rel_mse += share * e.rel_mse, sum.ssim += share * e.ssim, sum.flip += share * e.flip;
    sum.most = std::max(sum.most, e.most);
    run.rmse_by_round.push_back(e.rmse);
    const ErrorSummary& told = drawings[i].told;
    run.told_rounds += told.is_known;
    run.told_inside += told.is_known && told.low <= e.rmse && e.rmse <= told.high;
  }
  sum.rmse = std::sqrt(squares);
  sum.psnr_db = psnr_db(sum.rmse);
  const auto [least, most] = std::minmax_element(run.rmse_by_round.begin(), run.rmse_by_round.end());
  run.rmse_low = *least, run.rmse_high = *most;
  run.efficiency = 1.0 / (squares * 1e-3 * run.time_ms);
}

}  // namespace tilelight::study
