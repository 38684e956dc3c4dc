// SPDX-License-Identifier: Apache-2.0
// EyeMedia: the media in which the primary rays of a view start. In perspective all start at the eye. In an
// orthographic view each starts at a place of its own on the image plane, and a medium may hold some and not others.
// Immutable after construction; any thread may read.
#pragma once

#include <span>
#include <vector>

#include "renderer/compile/compile.h"
#include "renderer/compile/compiled_scene.h"
#include "renderer/film/film.h"

namespace tilelight {

// Indices into CompiledScene::bodies, outermost first; one that is there twice is so because its shells overlap.
using MediaList = std::vector<uint32_t>;

class EyeMedia {
 public:
  EyeMedia(const CompiledScene& scene, const ViewPlan& plan);

  // Of every start, unless some_near says otherwise.
  const MediaList& around_all() const { return around_all_; }
  // The media that may hold the start of a ray of these pixels, but need not hold all. Empty in perspective.
  MediaList some_near(const TileRect& pixels) const;
  // Which of them hold a start, normalised world, and how often.
  MediaList around(const Vec3& start, std::span<const uint32_t> some) const;

 private:
  // A medium that the image plane may cut, and the pixels in which it may.
  struct Cut {
    uint32_t body = 0;
    double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;
  };
  void find_cuts(const Eye& eye);

  const CompiledScene& scene_;
  MediaList around_all_;
  std::vector<Cut> cuts_;
};

}  // namespace tilelight
