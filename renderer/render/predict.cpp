// SPDX-License-Identifier: Apache-2.0
#include "renderer/render/predict.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "renderer/base/elementary.h"
#include "renderer/base/standard_floats.h"
#include "renderer/compile/tessellate.h"
#include "renderer/film/error_map.h"
#include "renderer/film/film.h"
#include "renderer/render/pass_schedule.h"
#include "renderer/render/probe.h"
#include "renderer/render/spend.h"

namespace tilelight {
namespace {

// What the model of a picture leaves out, measured over the example scenes: relative standard deviations.
constexpr double kPriceDeviation = 0.15;  // of the time of a ray
constexpr double kModelDeviation = 0.15;  // of the error, beside the chance of which spots were probed
// Of the variance, what does not lie where a probe shows it: there samples that go where the error is do not find it.
constexpr double kHidden = 0.05;
// Samples that go where the error is, in short passes over scattered cells, cost more than those for all.
constexpr double kSpentPrice = 1.8;
constexpr double kSketchPrice = 2.5;  // single pixels make no packets
constexpr double kNormal95 = 1.96;
constexpr double kReporting = 1.03;  // time with the error told over time without
constexpr double kToldHigh = 1.1;    // the upper end of what is told over the error, in large pictures

struct Outcome {
  double spp = 0.0, elapsed_ms = 0.0, rmse = -1.0;
  double mean_samples = 0.0;  // a pixel's, that have the rays of a mean one: where they go, samples may be dear
};

// A picture that is made of the probed spots alone; each is a cell that stands for its share of the image.
class Model {
 public:
  // ms_a_sample: of a pixel, over the whole image. error_scale: of the errors.
  Model(const Probe& probe, const RenderSpec& spec, double ms_a_sample, double error_scale)
      : probe_(probe),
        schedule_(spec),
        time_ms_(spec.time_ms),
        ms_a_sample_(ms_a_sample),
        variance_scale_(error_scale * error_scale),
        film_(std::max<int>(1, static_cast<int>(probe.variances.size())) * kCellPx, kCellPx) {
    const double mean = std::accumulate(probe.variances.begin(), probe.variances.end(), 0.0) /
                        std::max<double>(1.0, static_cast<double>(probe.variances.size()));
    for (const double variance : probe.variances) variances_.push_back(variance + kHidden * (mean - variance));
  }

  Outcome run() {
    Standing standing;
    for (;;) {
      const PassSchedule::Next next = schedule_.next(standing);
      if (next.samples == 0.0) break;
      const double ms = take(next);
      if (time_ms_ && standing.passes > 0 && standing.elapsed_ms + ms > *time_ms_) {
        standing.elapsed_ms = *time_ms_;  // a pass that runs over the limit does not count
        break;
      }
      counted_ += taken_;
      const double spp = next.is_sketch ? kSketchSamples : mean_samples();
      standing = {.passes = standing.passes + 1,
                  .spp = spp,
                  .elapsed_ms = standing.elapsed_ms + ms,
                  .ms_per_sample = ms / std::max(1e-9, spp - standing.spp),
                  .was_for_all = next.for_all,
                  .rmse = spp >= 2.0 && knows_errors() ? kToldHigh * rmse() : standing.rmse};
      rmse_ = knows_errors() && !next.is_sketch ? rmse() : -1.0;
    }
    return {standing.spp, standing.elapsed_ms, rmse_, counted_};
  }

 private:
  bool knows_errors() const { return !probe_.variances.empty(); }

  double variance(size_t cell) const {
    const double octaves = elementary::log2(static_cast<double>(film_.samples()[cell]) / kProbeSamples);
    return variance_scale_ * variances_[cell] * elementary::exp2(octaves * elementary::log2(probe_.decay));
  }

  double rmse() const {
    double sum = 0.0;
    for (size_t i = 0; i < probe_.variances.size(); ++i) sum += variance(i);
    return std::sqrt(sum / static_cast<double>(probe_.variances.size()));
  }

  double mean_samples() const {
    return std::accumulate(film_.samples().begin(), film_.samples().end(), 0.0) /
           static_cast<double>(film_.samples().size());
  }

  // The time that the pass takes, ms; and its mean samples in taken_.
  double take(const PassSchedule::Next& next) {
    if (next.is_sketch) {
      taken_ = kSketchSamples;
      return kSketchPrice * taken_ * ms_a_sample_;
    }
    std::vector<uint32_t> targets = film_.samples();
    if (next.for_all || !knows_errors()) {
      for (uint32_t& samples : targets) samples += std::max(1u, static_cast<uint32_t>(next.samples));
    } else {
      std::vector<float> variances(targets.size());
      for (size_t i = 0; i < variances.size(); ++i) variances[i] = static_cast<float>(variance(i));
      targets = spend(film_, variances, next.samples);
    }
    double samples = 0.0;
    const double price = next.for_all ? 1.0 : kSpentPrice;
    for (size_t i = 0; i < targets.size(); ++i)
      samples += (targets[i] - film_.samples()[i]) * (knows_errors() ? probe_.costs[i] : 1.0);
    film_.samples() = std::move(targets);
    taken_ = samples / static_cast<double>(film_.samples().size());
    return price * ms_a_sample_ * taken_;
  }

  const Probe& probe_;
  const PassSchedule schedule_;
  const std::optional<double> time_ms_;
  const double ms_a_sample_, variance_scale_;
  std::vector<double> variances_;
  Film film_;  // its counts of samples alone
  double rmse_ = -1.0;
  double taken_ = 0.0, counted_ = 0.0;  // mean samples: of the pass in work, of those that count
};

// Among how many spots the variance is, were it the same in each of them.
double spots_that_count(const Probe& probe) {
  double sum = 0.0, squares = 0.0;
  for (const double variance : probe.variances) sum += variance, squares += variance * variance;
  return squares > 0.0 ? sum * sum / squares : 0.0;
}

// Of the error, by the chance of which spots were probed: a few of them may hold most of it, and then their own
// scatter, a quarter of 1 / n, says too little of what was missed.
double error_deviation(const Probe& probe) {
  const double count = spots_that_count(probe);
  const double chance = count > 0.0 ? 0.75 * (1.0 - probe.image_part) / count : 0.0;
  return std::sqrt(kModelDeviation * kModelDeviation + chance);
}

// A decay that few spots tell is moved to that of an edge.
double sober_decay(const Probe& probe) {
  constexpr double kFew = 8.0;
  const double count = spots_that_count(probe);
  return elementary::exp((count * elementary::log(probe.decay) + kFew * elementary::log(kEdgeDecay)) / (count + kFew));
}

}  // namespace

CostPrediction predict_cost(const std::shared_ptr<const CompiledScene>& scene, const ViewPlan& plan, TilePool& pool,
                            double probe_budget_ms) {
  const StandardFloats floats;
  const auto start = std::chrono::steady_clock::now();
  const int threads = pool.thread_count();
  Probe probe = probe_view(*drawn_scene(scene, plan, pool), plan, probe_budget_ms);
  probe.decay = sober_decay(probe);
  const double pixels = plan.view.image.width * static_cast<double>(plan.view.image.height);
  const double cpu_ms_a_sample = kReporting * pixels * probe.rays_per_sample * probe.ms_per_ray;
  const double ms_a_sample = cpu_ms_a_sample / threads;
  const RenderSpec& spec = plan.view.render;

  const Outcome middle = Model(probe, spec, ms_a_sample, 1.0).run();
  CostPrediction out;
  out.spp = middle.spp;
  out.mrays = 1e-6 * pixels * probe.rays_per_sample * middle.mean_samples;
  out.elapsed_ms = out.elapsed_low_ms = out.elapsed_high_ms = middle.elapsed_ms;
  out.cpu_ms = middle.elapsed_ms * threads;
  out.rmse = out.rmse_low = out.rmse_high = middle.rmse;
  const double price = kNormal95 * kPriceDeviation, error = kNormal95 * error_deviation(probe);
  for (const double sign_of_price : {-1.0, 1.0}) {
    for (const double sign_of_error : {-1.0, 1.0}) {
      const double error_scale = elementary::exp(sign_of_error * error);
      const Outcome o = Model(probe, spec, ms_a_sample * elementary::exp(sign_of_price * price), error_scale).run();
      out.elapsed_low_ms = std::min(out.elapsed_low_ms, o.elapsed_ms);
      out.elapsed_high_ms = std::max(out.elapsed_high_ms, o.elapsed_ms);
      out.rmse_low = std::min(out.rmse_low, o.rmse);
      out.rmse_high = std::max(out.rmse_high, o.rmse);
    }
  }
  // Passes are whole, the clock is looked at between them, and what is told of a picture is a little more than its
  // error.
  out.elapsed_low_ms *= 0.95;
  out.elapsed_high_ms *= 1.05;
  if (out.rmse >= 0.0) out.rmse_low = 0.75 * std::max(0.0, out.rmse_low), out.rmse_high *= 1.1;
  out.probe_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return out;
}

}  // namespace tilelight
