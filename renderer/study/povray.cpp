// SPDX-License-Identifier: Apache-2.0
// The peer at its best: many settings of POV-Ray's anti-aliasing are tried once each; those that come to an error in
// the least processor time are then drawn as often as our own runs, and are its series.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "renderer/study/pov_scene.h"
#include "renderer/study/povray_run.h"
#include "renderer/study/studio.h"

namespace tilelight::study {
namespace {

struct Trial {
  PovSetting setting;
  Drawing drawing;
  double rmse;
};

class Peer {
 public:
  Peer(const Studio& studio, const Scene& scene, const View& view, const Image& truth, Study& study)
      : studio_(studio),
        image_(view.image),
        truth_(truth),
        shown_truth_(displayed_image(truth, view.image.exposure)),
        study_(study),
        scene_(pov_scene(scene, view)),
        povray_(scene_, view.image, studio.pool().thread_count()) {}

  // Throws std::exception where POV-Ray cannot be used; the study is as it was then.
  void draw_beside() {
    choose_bounding();
    sweep();
    mark_front();
    StudySeries series = drawn_as_often(chosen());
    study_.series.push_back(std::move(series));
    for (size_t i = 0; i < trials_.size(); ++i) {
      const auto& [setting, drawing, rmse] = trials_[i];
      study_.peer_trials.push_back(
          {setting.words(), drawing.spp, drawing.time_ms, drawing.cpu_ms, rmse, is_on_front_[i]});
    }
    std::sort(study_.peer_trials.begin(), study_.peer_trials.end(),
              [](const PeerTrial& a, const PeerTrial& b) { return a.cpu_ms < b.cpu_ms; });
    add_notes();
  }

 private:
  const Trial& try_once(const PovSetting& setting) {
    studio_.tell("POV-Ray " + setting.words(), 0.9);
    Trial trial{setting, povray_.draw(setting), 0.0};
    trial.rmse = rms_difference(displayed_image(*trial.drawing.image, image_.exposure), shown_truth_);
    return trials_.emplace_back(std::move(trial));
  }

  // The faster of its two trees.
  void choose_bounding() {
    PovSetting setting{.method = 1, .threshold = 0.0, .depth = 2};
    const double boxes_ms = povray_.draw(setting).cpu_ms;
    setting.bounding = 2;
    if (povray_.draw(setting).cpu_ms < boxes_ms) bounding_ = 2;
  }

  // Deeper as long as that helps and no other setting needs half the time for it. Jitter only where the same without
  // was worth while.
  void sweep() {
    try_once({.bounding = bounding_});
    for (const int method : {2, 1}) {
      for (const double threshold : {0.3, 0.1, 0.03, 0.01, 0.003, 0.0}) {
        double last = INFINITY;
        for (const int depth : method == 1 ? std::vector{2, 3, 4, 6, kPovMostDepth} : std::vector{1, 2, 3, 4, 5}) {
          if (method == 2 && threshold == 0.0 && depth > 3) break;  // all of a grid of 16 x 16
          constexpr double kHelps = 0.97;
          const Trial& trial = try_once({method, threshold, depth, false, bounding_});
          if (trial.rmse > kHelps * last || is_hopeless(trial)) break;
          last = trial.rmse;
        }
      }
    }
    mark_front();
    std::vector<PovSetting> worth_while;
    for (size_t i = 0; i < trials_.size(); ++i)
      if (is_on_front_[i] && trials_[i].setting.depth > 1) worth_while.push_back(trials_[i].setting);
    for (PovSetting setting : worth_while) {
      setting.has_jitter = true;
      try_once(setting);
    }
  }

  bool is_hopeless(const Trial& trial) const {
    return std::any_of(trials_.begin(), trials_.end(), [&](const Trial& other) {
      return other.rmse <= trial.rmse && 2.0 * other.drawing.cpu_ms < trial.drawing.cpu_ms;
    });
  }

  std::vector<Sample> samples() const {
    std::vector<Sample> out;
    for (const Trial& trial : trials_) out.push_back({trial.drawing.cpu_ms, trial.rmse});
    return out;
  }
  void mark_front() { is_on_front_ = pareto_front(samples()); }

  std::vector<PovSetting> chosen() const {
    std::vector<PovSetting> out;
    for (const size_t i : steps_of_front(samples(), std::sqrt(2.0))) out.push_back(trials_[i].setting);
    return out;
  }

  StudySeries drawn_as_often(const std::vector<PovSetting>& settings) const {
    StudySeries series{.name = "POV-Ray",
                       .method = "POV-Ray",
                       .shading = "phong",
                       .sampling = "its best settings",
                       .precision = "double"};
    std::vector<std::vector<Drawing>> drawings(settings.size());
    for (int round = 0; round < studio_.options().rounds; ++round) {
      for (size_t i = 0; i < settings.size(); ++i) {
        studio_.tell("POV-Ray, round " + std::to_string(round + 1) + ": " + settings[i].words(), 0.95);
        drawings[i].push_back(povray_.draw(settings[i]));
      }
    }
    for (size_t i = 0; i < settings.size(); ++i) {
      StudyRun run;
      run.setting = settings[i].words();
      time_run(run, drawings[i]);
      judge(run, drawings[i], truth_, image_.exposure, studio_.pool());
      series.runs.push_back(std::move(run));
    }
    return series;
  }

  void add_notes() {
    const auto least = std::min_element(trials_.begin(), trials_.end(),
                                        [](const Trial& a, const Trial& b) { return a.rmse < b.rmse; });
    std::ostringstream note;
    note << "POV-Ray's best picture (" << least->setting.words() << ", " << least->drawing.spp
         << " samples a pixel) is " << least->rmse << " off ours, rmse: its curve ends there.";
    study_.notes.push_back(note.str());
    if (scene_.differences.empty()) study_.notes.emplace_back("POV-Ray draws all of this scene as we do.");
    for (const std::string& difference : scene_.differences)
      study_.notes.push_back("POV-Ray draws otherwise: " + difference);
  }

  const Studio& studio_;
  const ImageSpec image_;
  const Image& truth_;
  const DisplayedImage shown_truth_;
  Study& study_;
  const PovScene scene_;
  const PovRay povray_;
  int bounding_ = 1;
  std::vector<Trial> trials_;
  std::vector<bool> is_on_front_;  // by trial: no other has less error in less processor time
};

}  // namespace

void add_povray(const Studio& studio, const Scene& scene, const View& view, const Image& truth, Study& study) {
  try {
    Peer(studio, scene, view, truth, study).draw_beside();
  } catch (const std::exception& error) {
    studio.stop_if_cancelled();  // Ctrl-C reaches POV-Ray too
    study.notes.push_back(std::string("POV-Ray is not beside ours (Debian: apt install povray): ") + error.what());
  }
}

}  // namespace tilelight::study
