// SPDX-License-Identifier: Apache-2.0
// POV-Ray, a program of its own: one scene, drawn by it with the settings of its anti-aliasing.
#pragma once

#include <string>

#include "renderer/base/child_process.h"
#include "renderer/study/pov_scene.h"
#include "renderer/study/studio.h"

namespace tilelight::study {

struct PovSetting {
  // 0: one ray through the middle of every pixel. 1: depth^2 more where a pixel differs from its neighbours. 2: corners
  // of pixels, between them more wherever these differ, halved depth - 1 times at most.
  int method = 0;
  double threshold = 0.0;  // what counts as differing, sum over three channels that end at 1
  int depth = 1;           // 1 to 9
  bool has_jitter = false;
  int bounding = 1;  // 1: a tree of boxes; 2: a tree of planes

  // As on its command line.
  std::string words() const;
  bool operator==(const PovSetting&) const = default;
};
inline constexpr int kPovMostDepth = 9;

class PovRay {
 public:
  // Throws std::system_error where there is no place for files.
  PovRay(const PovScene& scene, const ImageSpec& image, int threads);

  // The picture in linear light, before exposure. Times are those that POV-Ray says tracing took; samples a pixel are
  // all rays from the eye, also those beyond the picture's blocks. Throws std::exception where POV-Ray is not there,
  // fails, or says something else than it used to.
  Drawing draw(const PovSetting& setting) const;

 private:
  const ImageSpec image_;
  const int threads_;
  TemporaryFolder folder_;
};

bool is_povray_installed();

}  // namespace tilelight::study
