// SPDX-License-Identifier: Apache-2.0
// The work-precision study of a scene: how wrong its pictures are by every method that can draw it, against how long
// they take. README.md tells how to read one.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/measure/image_error.h"
#include "renderer/render/predict.h"
#include "renderer/render/render.h"
#include "renderer/scene/parse.h"
#include "renderer/study/statistics.h"

namespace tilelight {

struct StudyOptions {
  int most_samples = 32;  // of the finest run, a pixel: a power of two from 8 on
  int rounds = 5;         // of every run, each with a seed of its own
  bool with_povray = false;
  // What is being done, and which part of the whole is done; by the calling thread.
  std::function<void(const std::string&, double)> on_progress = {};
  // Asked between runs; true ends the study early, with no result.
  std::function<bool()> is_cancelled = {};
};

// The rounds of one way to draw the picture.
struct StudyRun {
  double asked_samples = 0.0;                                   // 0: the run is another program's
  std::string setting;                                          // what was asked, in words
  double spp = 0.0;                                             // samples a pixel taken, mean
  double time_ms = 0.0, time_low_ms = 0.0, time_high_ms = 0.0;  // of the drawing: median, least and most
  double cpu_ms = 0.0;                                          // median
  ImageError error;  // rmse, p99 and rel_mse: root mean square or mean over rounds; most: the largest
  double rmse_low = 0.0, rmse_high = 0.0;  // least and most of the rounds
  std::vector<double> rmse_by_round;
  double told_rmse = -1.0;               // what the report said, mean; < 0: it said nothing
  int told_rounds = 0, told_inside = 0;  // rounds that told an interval; of them those whose true rmse is inside
  double efficiency = 0.0;               // 1 / (mse * seconds)
  bool is_on_front = false;              // no run of the study has less error in less time
};

// Runs of one method from few samples to many.
struct StudySeries {
  std::string name, method, shading, sampling, precision;
  std::vector<StudyRun> runs = {};
  std::optional<PowerLaw> by_samples = {}, by_time = {};  // how rmse falls, from four samples on
};

// One value of a knob beside its most exact one, with the same samples: what is left is the knob's alone.
struct KnobRow {
  std::string knob;
  double value = 0.0;
  bool is_of_scene = false, is_exact = false;
  double time_ms = 0.0;
  double rmse = 0.0;               // to the picture of the exact value
  double truncation = 0.0;         // how far its mean linear value is short of the exact one's
  double truncation_bound = -1.0;  // what the report says that it is at most; < 0: no bound
};

// Where the error of a picture comes from.
struct StudyComponents {
  double sampling = 0.0;           // rmse, of the finest run of the first series
  double truncation_bound = -1.0;  // of its mean linear value; < 0: none is finite
  double rounding = 0.0;           // rmse between the picture in float and double and its twin in double
  double quantisation = 0.0;       // of 8 bits, rmse
};

// A prediction beside what happened.
struct OracleRow {
  std::string rule;
  CostPrediction predicted;
  double elapsed_ms = 0.0, rmse = 0.0;  // median of the rounds; the true rmse
  bool is_time_inside = false;
  std::optional<bool> is_rmse_inside = {};  // none: no error was predicted
};

// One setting of another program, tried once.
struct PeerTrial {
  std::string setting;
  double spp = 0.0, time_ms = 0.0, cpu_ms = 0.0, rmse = 0.0;
  bool is_on_front = false;  // no other trial has less error in less processor time
};

struct Study {
  std::string scene_name, scene_id;
  std::string isa, kernel;
  int threads = 0, width = 0, height = 0, rounds = 0;
  double exposure = 0.0;
  double compile_ms = 0.0;
  int reference_samples = 0;    // a pixel, in both halves together
  double reference_rmse = 0.0;  // its own error, by half the difference of its halves
  double least_rmse = 0.0;      // of all runs; the reference should be ten times as good
  std::vector<StudySeries> series;
  std::vector<KnobRow> knobs;
  StudyComponents components;
  std::vector<OracleRow> oracle;
  std::vector<PeerTrial> peer_trials;  // the sweep by which the peer's settings were chosen; empty without a peer
  std::vector<std::string> notes;      // what was left out, and why

  std::shared_ptr<const Image> reference, picture;  // linear; the picture is the finest one of the first series
  std::vector<float> told_bounds;                   // by pixel, of the picture
};

// The view's stop rules are replaced. Takes some minutes. None if it was cancelled.
std::optional<Study> make_study(const ParsedScene& parsed, const std::string& name, TilePool& pool,
                                const StudyOptions& options);

// The view that a study draws: as in the scene, in about 32,000 pixels.
ImageSpec study_size(const ImageSpec& image);

// Files of a study: all its numbers; its runs as rows; its curves; a page to look at, which shows the pictures
// reference.png, picture.png, error.png and told.png beside it.
std::string study_json(const Study& study);
std::string study_csv(const Study& study);
std::string study_svg(const Study& study);
std::string study_html(const Study& study);

}  // namespace tilelight
