// SPDX-License-Identifier: Apache-2.0
// ExposedFilm: what the whole passes of a render have made and learnt. A render writes its own; once the render is done
// nobody writes it any more, and others go on from copies of it. Any thread may then read.
#pragma once

#include <memory>
#include <vector>

#include "renderer/film/error_map.h"
#include "renderer/film/film.h"
#include "renderer/render/pass_schedule.h"
#include "renderer/render/render.h"

namespace tilelight {

// What the items of a render have counted.
struct Tally {
  RayCounts rays;
  int64_t nonfinite = 0, lights_on_hits = 0;
  double untraced_weight = 0.0;  // the most of a sample
  double cpu_ms = 0.0;
};

struct ExposedFilm {
  ExposedFilm(int width, int height, double exposure_stops)
      : film(width, height), error_map(width, height, exposure_stops) {}

  Film film;
  ErrorMap error_map;  // with what it remembers of earlier passes
  Standing standing;
  Tally tally;
  // Of the last pass; null before the first.
  std::shared_ptr<const Image> image;
  std::shared_ptr<const std::vector<float>> error_bounds;
};

}  // namespace tilelight
