// SPDX-License-Identifier: Apache-2.0
#include "renderer/study/study.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "renderer/film/tone.h"
#include "renderer/measure/reference.h"
#include "renderer/scene/words.h"
#include "renderer/study/studio.h"

namespace tilelight {

using namespace study;

namespace {

constexpr uint32_t kReferenceSeed = 1'000'000'007;  // far from those of the rounds
constexpr int kReferenceOverFinest = 32;  // samples of each half of the reference over those of the finest run
constexpr int kMostDoublings = 2;         // of the reference, until it is ten times as good as the best run
constexpr int kTwinRounds = 2;
constexpr int kMostOfOthers = 16;  // samples, of methods whose error is soon that of their light
constexpr double kScored = 4.0;    // samples from which a curve's slope counts

// A series and, until it has been judged, its pictures.
struct Drawn {
  StudySeries series;
  std::vector<View> views = {};                     // by run
  std::vector<std::vector<Drawing>> drawings = {};  // by run, by round
};

std::string words_of(int samples, bool is_adaptive) {
  return std::to_string(samples) + (samples == 1 ? " sample" : " samples") + (is_adaptive ? " where the error is" : "");
}

class Maker {
 public:
  Maker(const ParsedScene& parsed, const std::string& name, const Studio& studio)
      : studio_(studio), scene_(parsed.scene), view_(parsed.view) {
    study_.scene_name = name;
    study_.scene_id = parsed.scene_id;
    study_.threads = studio.pool().thread_count();
    study_.width = view_.image.width, study_.height = view_.image.height;
    study_.exposure = view_.image.exposure;
    study_.rounds = studio.options().rounds;
    // Whatever the scene asks for: the reference has the whole light model, and every method is set beside it.
    view_.render.algorithm = Algorithm::raytrace, view_.render.shading = Shading::phong;
    asked_ = parsed.view.render;
  }

  Study make() {
    const auto start = std::chrono::steady_clock::now();
    compiled_ = compile_scene(scene_, studio_.pool());
    study_.compile_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    const ViewPlan plan = plan_view(*compiled_, view_);
    study_.isa = plan.plan.isa, study_.kernel = plan.plan.kernel;
    view_ = plan.view;

    std::vector<Drawn> all;
    // The whole light model first: it has the reference's light, and the others are compared with it.
    for (const bool is_adaptive : {false, true})
      all.push_back(ask_series(Algorithm::raytrace, Shading::phong, is_adaptive, studio_.options().most_samples));
    for (const auto& [algorithm, name] : kAlgorithms) {
      if (algorithm == Algorithm::roberts) continue;  // lines are no picture of the same light
      for (const auto& [shading, shading_name] : kShadings) {
        if (algorithm == Algorithm::raytrace && shading == Shading::phong) continue;
        all.push_back(ask_series(algorithm, shading, false, std::min(kMostOfOthers, studio_.options().most_samples)));
      }
    }
    draw_rounds(all);
    all.push_back(draw_twin());
    draw_reference(all);
    studio_.tell("comparing", 0.68);
    for (Drawn& drawn : all) judge_series(drawn);
    study_.picture = all.front().drawings.back().front().image;
    study_.told_bounds = *all.front().drawings.back().front().bounds;

    studio_.tell("turning the knobs", 0.72);
    study_.knobs = turn_knobs(studio_, scene_, view_);
    if (study_.knobs.empty())
      study_.notes.emplace_back(
          "No knobs: the scene has no mirror, no glass and no chessman, so depth, cut-off and detail change nothing.");
    studio_.tell("asking the oracle", 0.85);
    study_.oracle = ask_oracle(studio_, compiled_, view_, *study_.reference, study_.series.front());
    if (studio_.options().with_povray) {
      studio_.tell("POV-Ray", 0.9);
      View asked = view_;
      asked.render.algorithm = asked_.algorithm, asked.render.shading = asked_.shading;
      add_povray(studio_, scene_, asked, *study_.reference, study_);
    }
    take_components(all);
    mark_front();
    for (StudySeries& series : study_.series) fit(series);
    return std::move(study_);
  }

 private:
  // The runs of a series, not yet drawn.
  Drawn ask_series(Algorithm algorithm, Shading shading, bool is_adaptive, int most_samples) const {
    const std::string method(get_word(kAlgorithms, algorithm)), shading_name(get_word(kShadings, shading));
    const std::string sampling = is_adaptive ? "adaptive" : "uniform";
    Drawn out{{.name = method + ", " + shading_name + ", " + sampling,
               .method = method,
               .shading = shading_name,
               .sampling = sampling,
               .precision = "float filter, double"},
              {},
              {}};
    for (int samples = is_adaptive ? 8 : 1; samples <= most_samples; samples *= 2) {
      View view = with_samples(view_, samples, is_adaptive);
      view.render.algorithm = algorithm;
      view.render.shading = shading;
      out.views.push_back(view);
      StudyRun run;
      run.asked_samples = samples;
      run.setting = words_of(samples, is_adaptive);
      out.series.runs.push_back(run);
    }
    out.drawings.resize(out.views.size());
    return out;
  }

  // All runs once, then once more: what slows the machine down for a while slows one round of each and no median.
  void draw_rounds(std::vector<Drawn>& all) const {
    const int rounds = studio_.options().rounds;
    for (int round = 1; round <= rounds; ++round) {
      for (Drawn& drawn : all) {
        studio_.tell("round " + std::to_string(round) + ": " + drawn.series.name, 0.25 * (round - 1) / rounds);
        for (size_t i = 0; i < drawn.views.size(); ++i) {
          drawn.views[i].render.seed = static_cast<uint32_t>(round);
          drawn.drawings[i].push_back(studio_.draw(compiled_, drawn.views[i]));
        }
      }
    }
    for (Drawn& drawn : all)
      for (size_t i = 0; i < drawn.views.size(); ++i) time_run(drawn.series.runs[i], drawn.drawings[i]);
  }

  // The reference renderer, in double and without a line of the kernels, at the samples of the first rounds.
  Drawn draw_twin() {
    Drawn out{{.name = "reference renderer",
               .method = "raytrace",
               .shading = "phong",
               .sampling = "uniform",
               .precision = "double"},
              {}};
    const ReferenceScene reference(scene_);
    for (const int samples : {1, 4}) {
      studio_.tell("the twin in double, " + words_of(samples, false), 0.3 + 0.02 * samples);
      std::vector<Drawing> rounds;
      for (int round = 1; round <= std::min(kTwinRounds, studio_.options().rounds); ++round)
        rounds.push_back(draw_in_double(reference, samples, static_cast<uint32_t>(round)));
      StudyRun run;
      time_run(run, rounds);
      run.asked_samples = samples;
      run.setting = words_of(samples, false);
      out.series.runs.push_back(std::move(run));
      out.drawings.push_back(std::move(rounds));
    }
    return out;
  }

  Drawing draw_in_double(const ReferenceScene& reference, int samples, uint32_t seed) {
    View view = with_samples(view_, samples, false);
    view.render.seed = seed;
    auto image = std::make_shared<Image>(
        Image{study_.width, study_.height, std::vector<float>(static_cast<size_t>(study_.width) * study_.height * 3)});
    std::vector<Color> sums(image->rgb.size() / 3, Color(0.0));
    const auto start = std::chrono::steady_clock::now();
    for (int sample = 0; sample < samples; ++sample) {
      studio_.stop_if_cancelled();
      const auto pixels = reference_image(reference, view, *view.camera, studio_.pool(), static_cast<uint32_t>(sample));
      for (size_t i = 0; i < sums.size(); ++i) sums[i] += pixels[i].color;
    }
    for (size_t i = 0; i < sums.size(); ++i)
      for (int c = 0; c < 3; ++c) image->rgb[3 * i + static_cast<size_t>(c)] = static_cast<float>(sums[i][c] / samples);
    Drawing out;
    out.time_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    out.image = std::move(image);
    out.spp = samples;
    return out;
  }

  // Two pictures with seeds of their own; by how much they differ tells the error of their mean. Twice the samples
  // until it is a tenth of that of the best run, or it takes too long.
  void draw_reference(const std::vector<Drawn>& all) {
    int samples = kReferenceOverFinest * studio_.options().most_samples;
    for (int doublings = 0;; ++doublings, samples *= 2) {
      std::vector<std::shared_ptr<const Image>> halves;
      for (const uint32_t half : {0u, 1u}) {
        studio_.tell("the reference, " + std::to_string(2 * samples) + " samples a pixel",
                     0.3 + 0.1 * half + 0.12 * doublings);
        View view = with_samples(view_, samples, false);
        view.render.seed = kReferenceSeed + half;
        halves.push_back(studio_.draw(compiled_, view).image);
      }
      auto mean = std::make_shared<Image>(*halves[0]);
      for (size_t i = 0; i < mean->rgb.size(); ++i) mean->rgb[i] = 0.5f * (mean->rgb[i] + halves[1]->rgb[i]);
      study_.reference_rmse = 0.5 * rms_difference(displayed_image(*halves[0], study_.exposure),
                                                   displayed_image(*halves[1], study_.exposure));
      study_.reference_samples = 2 * samples;
      study_.reference = mean;
      double least = std::numeric_limits<double>::infinity();
      for (const Drawn& drawn : all)
        for (const auto& rounds : drawn.drawings) least = std::min(least, rmse_to_reference(*rounds.front().image));
      if (study_.reference_rmse <= 0.1 * least || doublings == kMostDoublings) return;
    }
  }

  double rmse_to_reference(const Image& image) const {
    return rms_difference(displayed_image(image, study_.exposure), displayed_image(*study_.reference, study_.exposure));
  }

  void judge_series(Drawn& drawn) {
    for (size_t i = 0; i < drawn.series.runs.size(); ++i)
      judge(drawn.series.runs[i], drawn.drawings[i], *study_.reference, study_.exposure, studio_.pool());
    study_.series.push_back(drawn.series);
  }

  void take_components(const std::vector<Drawn>& all) {
    const Drawn &ours = all.front(), &twin = all.back();
    study_.components.sampling = study_.series.front().runs.back().error.rmse;
    study_.components.truncation_bound = ours.drawings.back().front().truncation_bound;
    // Of four samples, the same in both.
    study_.components.rounding = rms_difference(displayed_image(*ours.drawings[2].front().image, study_.exposure),
                                                displayed_image(*twin.drawings.back().front().image, study_.exposure));
    const DisplayedImage shown = displayed_image(*study_.picture, study_.exposure);
    DisplayedImage bytes = shown;
    const std::vector<uint8_t> rounded = to_srgb8(*study_.picture, study_.exposure);
    for (size_t i = 0; i < rounded.size(); ++i) bytes.rgb[i] = static_cast<float>(rounded[i]) / 255.0f;
    study_.components.quantisation = rms_difference(bytes, shown);
  }

  void mark_front() {
    std::vector<Sample> samples;
    for (const StudySeries& series : study_.series)
      for (const StudyRun& run : series.runs) samples.push_back({run.time_ms, run.error.rmse});
    const std::vector<bool> front = pareto_front(samples);
    size_t i = 0;
    study_.least_rmse = samples.front().y;
    for (StudySeries& series : study_.series) {
      for (StudyRun& run : series.runs) {
        run.is_on_front = front[i++];
        if (series.method != "POV-Ray") study_.least_rmse = std::min(study_.least_rmse, run.error.rmse);
      }
    }
  }

  static void fit(StudySeries& series) {
    std::vector<Sample> by_samples, by_time;
    for (const StudyRun& run : series.runs) {
      if (run.spp < kScored) continue;
      for (const double rmse : run.rmse_by_round)
        by_samples.push_back({run.spp, rmse}), by_time.push_back({run.time_ms, rmse});
    }
    series.by_samples = fit_power_law(by_samples);
    series.by_time = fit_power_law(by_time);
  }

  const Studio& studio_;
  const Scene& scene_;
  View view_;
  RenderSpec asked_;  // by the scene
  std::shared_ptr<const CompiledScene> compiled_;
  Study study_;
};

}  // namespace

ImageSpec study_size(const ImageSpec& image) {
  constexpr double kPixels = 32'000.0;
  ImageSpec out = image;
  const double shrink = std::min(1.0, std::sqrt(kPixels / (static_cast<double>(image.width) * image.height)));
  out.width = std::max(1, static_cast<int>(std::lround(image.width * shrink)));
  out.height = std::max(1, static_cast<int>(std::lround(image.height * shrink)));
  return out;
}

std::optional<Study> make_study(const ParsedScene& parsed, const std::string& name, TilePool& pool,
                                const StudyOptions& options) {
  try {
    const Studio studio(pool, options);
    return Maker(parsed, name, studio).make();
  } catch (const Cancelled&) {
    return std::nullopt;
  }
}

}  // namespace tilelight
