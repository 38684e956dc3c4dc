// SPDX-License-Identifier: Apache-2.0
// What the parts of a study share: drawing a view and waiting for it, in rounds, and judging what came out.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "renderer/study/study.h"

namespace tilelight::study {

// Thrown out of a drawing once the study is cancelled.
struct Cancelled {};

struct Drawing {
  std::shared_ptr<const Image> image;
  std::shared_ptr<const std::vector<float>> bounds;  // null: the method tells none
  double time_ms = 0.0, cpu_ms = 0.0, spp = 0.0;
  ErrorSummary told;
  double truncation_bound = -1.0;
  RayCounts rays = {};
};

class Studio {
 public:
  Studio(TilePool& pool, const StudyOptions& options) : pool_(pool), options_(options) {}

  TilePool& pool() const { return pool_; }
  const StudyOptions& options() const { return options_; }

  // Throws Cancelled, and std::runtime_error where the render fails.
  Drawing draw(const std::shared_ptr<const CompiledScene>& scene, const View& view) const;
  // The same with seeds from 1 on.
  std::vector<Drawing> draw_rounds(const std::shared_ptr<const CompiledScene>& scene, View view) const;

  void stop_if_cancelled() const;
  // `done` of the study's whole, [0, 1].
  void tell(const std::string& what, double done) const;

 private:
  TilePool& pool_;
  const StudyOptions& options_;
};

// Only the rule that is given, and samples for all alike or where the error is.
View with_samples(View view, int samples, bool is_adaptive);

// What the rounds' times and tellings come to. REQUIRES: drawings is not empty.
void time_run(StudyRun& run, const std::vector<Drawing>& drawings);
// The same drawings beside the truth, their errors on the pool.
void judge(StudyRun& run, const std::vector<Drawing>& drawings, const Image& truth, double exposure, TilePool& pool);

// Parts of a study in files of their own.
std::vector<KnobRow> turn_knobs(const Studio& studio, const Scene& scene, const View& view);
std::vector<OracleRow> ask_oracle(const Studio& studio, const std::shared_ptr<const CompiledScene>& scene,
                                  const View& view, const Image& truth, const StudySeries& uniform);
// The scene by POV-Ray, at rising samples, beside the truth; what cannot be had is said in notes.
void add_povray(const Studio& studio, const Scene& scene, const View& view, const Image& truth, Study& study);

}  // namespace tilelight::study
