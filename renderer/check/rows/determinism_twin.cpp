// SPDX-License-Identifier: Apache-2.0
// D3: the renderer and its twin in double.
#include <algorithm>
#include <cmath>

#include "renderer/check/kit/pictures.h"
#include "renderer/check/kit/textbook.h"
#include "renderer/check/rows/determinism.h"
#include "renderer/check/rows/determinism_scenes.h"
#include "renderer/film/tone.h"

namespace tilelight::check {
namespace {

struct Apart {
  double ids = 0.0, bytes = 0.0, values = 0.0;  // % of the pixels
};

// Pixels whose checker cells are under a quarter of a pixel count for their ids alone: compare_images.
Apart apart(const ParsedScene& parsed, TilePool& pool) {
  const Picture picture = picture_of(parsed, pool);
  const ReferenceScene twin(parsed.scene);
  const auto pixels = reference_image(twin, parsed.view, *parsed.view.camera, pool);
  const double exposure = parsed.view.image.exposure;
  const ShownImage shown = shown_image(pixels, picture.width, picture.height, exposure);
  const ImageDifference d = compare_images({picture.rgb, picture.ids}, shown, pixels);

  size_t values = 0;
  for (size_t i = 0; i < pixels.size(); ++i) {
    double most = 0.0;
    for (int c = 0; c < 3; ++c) {
      const double here = displayed(picture.linear[3 * i + static_cast<size_t>(c)], exposure);
      note(most, std::abs(here - displayed(pixels[i].color[c], exposure)));
    }
    values += !(most <= 1e-3) && pixels[i].checker_cell_px >= kFineCheckerPx;
  }
  return {100.0 * d.id_mismatch_rate(), 100.0 * d.q8_rate(),
          percent(static_cast<int64_t>(values), static_cast<int64_t>(pixels.size()))};
}

}  // namespace

Outcome of_twins(const Context& context) {
  Apart worst;
  double textbook_ids = 0.0;
  for (const char* json : {kShowcase, kChess, kExtremes}) {
    ParsedScene parsed = scene_of(json);
    parsed.view.render.samples = 1;
    // At the scene's own size: the textbook tries every triangle.
    const auto textbook = TextbookTracer(parsed.scene).picture(parsed.view, *parsed.view.camera, context.pool);
    note(textbook_ids, differing_ids(textbook.ids, reference_ids(parsed, context.pool)));
    if (!context.is_quick) parsed.view.image.width = parsed.view.image.height = 512;
    const Apart here = apart(parsed, context.pool);
    note(worst.ids, here.ids), note(worst.bytes, here.bytes), note(worst.values, here.values);
  }
  return {{at_most(0.01, "first surfaces that differ, %", worst.ids),
           at_most(0.05, "pixels of which a byte differs, %", worst.bytes),
           at_most(0.01, "pixels off by more than 1e-3, %", worst.values)},
          {at_most(0.01, "first surfaces that differ, %", textbook_ids)}};
}

}  // namespace tilelight::check
