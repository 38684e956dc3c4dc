// SPDX-License-Identifier: Apache-2.0
// The kernels and the reference renderer show the same picture of any scene. Pixels count where both are sure of
// themselves: an eye moved by a billionth sees the same surface in the same colour there.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "renderer/measure/judge.h"
#include "tests/fuzz/require.h"
#include "tests/fuzz/scene_from_bytes.h"

namespace tilelight::fuzz {
namespace {

constexpr int kWidth = 12, kHeight = 9;

// What may differ of the pixels that count: an edge that four eyes see in one way and the other renderer in another.
constexpr int kMostIds = 1, kMostColors = 2;

bool is_same(const ShownImage& a, const ShownImage& b, size_t pixel) {
  return a.primary_ids[pixel] == b.primary_ids[pixel] &&
         std::equal(&a.rgb[3 * pixel], &a.rgb[3 * pixel] + 3, &b.rgb[3 * pixel]);
}

// 1 for the pixels in which moved eyes see what the view's own sees, by either renderer.
std::vector<uint8_t> sure_pixels(const SceneAndView& made, const Verdict& verdict, TilePool& pool) {
  std::vector<uint8_t> sure(verdict.reference.size(), 1);
  const double step = 1e-9 * glm::length(made.view.camera->target - made.view.camera->position);
  for (const Vec3& way : {Vec3(0.61, 0.47, 0.64), Vec3(-0.39, -0.71, -0.58), Vec3(0.52, -0.66, 0.54)}) {
    View view = made.view;
    view.camera->position += step * way;
    view.camera->target += step * way;
    const Verdict moved = judge_view(made.scene, view, pool);
    for (size_t i = 0; i < sure.size(); ++i)
      sure[i] &= is_same(moved.fast, verdict.fast, i) && is_same(moved.shown_reference, verdict.shown_reference, i);
  }
  return sure;
}

struct Differing {
  int ids = 0, colors = 0;
  std::string told;
};

// Of the pixels that are sure. Pixels that see the cells of a fine checker are left out.
Differing differing(const Verdict& verdict, const std::vector<uint8_t>& sure) {
  Differing out;
  for (size_t i = 0; i < sure.size(); ++i) {
    if (!sure[i] || verdict.reference[i].checker_cell_px < kFineCheckerPx) continue;
    const uint64_t id = verdict.fast.primary_ids[i], true_id = verdict.reference[i].primary_id;
    int levels = 0;
    for (size_t c = 3 * i; c < 3 * i + 3; ++c)
      levels = std::max(levels, std::abs(verdict.fast.rgb[c] - verdict.shown_reference.rgb[c]));
    if (id == true_id && levels <= 1) continue;
    out.ids += id != true_id;
    out.colors += levels > 1;
    out.told += "pixel " + std::to_string(i % kWidth) + "," + std::to_string(i / kWidth) + ": body " +
                std::to_string(id >> 32) + " primitive " + std::to_string(id & 0xFFFFFFFFu) +
                " where the reference sees " + std::to_string(true_id >> 32) + " " +
                std::to_string(true_id & 0xFFFFFFFFu) + ", levels off: " + std::to_string(levels) + "\n";
  }
  return out;
}

bool is_small(const Differing& d) { return d.ids <= kMostIds && d.colors <= kMostColors; }

}  // namespace
}  // namespace tilelight::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace tilelight;
  using namespace tilelight::fuzz;
  static TilePool pool(1);
  SceneAndView made = scene_from_bytes(data, size);
  made.view.image = {kWidth, kHeight, 0.0};
  const Verdict verdict = judge_view(made.scene, made.view, pool);
  REQUIRE(verdict.fast_nonfinite == 0, told(made));
  for (const ReferencePixel& pixel : verdict.reference)
    REQUIRE(std::isfinite(pixel.color.r + pixel.color.g + pixel.color.b), "in the reference\n" + told(made));

  const Differing all = differing(verdict, std::vector<uint8_t>(verdict.reference.size(), 1));
  if (is_small(all)) return 0;  // moved eyes cost six more pictures
  const Differing sure = differing(verdict, sure_pixels(made, verdict, pool));
  REQUIRE(is_small(sure), sure.told + told(made));
  return 0;
}
