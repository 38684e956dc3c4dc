// SPDX-License-Identifier: Apache-2.0
// The chapters of the language on the view: camera, image, render.
#include "renderer/scene/grammar_rules.h"

namespace tilelight {
namespace {

std::shared_ptr<const Record> camera_record(std::string_view name, std::string_view title, Field lens) {
  return std::make_shared<const Record>(Record{
      name,
      title,
      {{"position", vector_rule(), "Eye", "Scene units.", "", Need::required},
       {"target", vector_rule(), "What it looks at", "Scene units.", "[0, 0, 0]"},
       {"up", direction_rule(), "Up",
        "Need not be at right angles to the view. Along it, +y takes its place; straight up or down, +x is on the "
        "right.",
        "[0, 1, 0]"},
       std::move(lens)}});
}

}  // namespace

Rule camera_grammar() {
  const Range half_turn{.min = 0.0, .max = 180.0, .above_min = true, .below_max = true};
  return {.form = Form::tagged,
          .tag_optional = true,
          .records = {camera_record("perspective", "A pinhole camera",
                                    {"fov_y_deg", number_rule(half_turn), "Field of view",
                                     "Degrees from the bottom to the top edge.", "40"}),
                      camera_record("orthographic", "A camera of parallel rays",
                                    {"height", number_rule(kPositive), "Height of the picture",
                                     "Scene units from the bottom to the top edge.", "", Need::required})}};
}

Rule image_grammar(const Limits& limits) {
  return record_rule(
      {"image",
       "Size and exposure",
       {{"width", whole_rule(1, limits.image_side, true), "Width", "Pixels.", "1280"},
        {"height", whole_rule(1, limits.image_side, true), "Height", "Pixels.", "720"},
        {"exposure", number_rule({.min = -1000.0, .max = 1000.0}), "Exposure", "Stops: factors of two.", "0"}}});
}

Rule render_grammar(const Limits& limits) {
  const Range pass{.min = 0.0, .max = static_cast<double>(limits.samples), .above_min = true, .is_limit = true};
  return record_rule(
      {"render",
       "Method and stop rules; the first rule that holds ends the render",
       {{"algorithm", words_rule(kAlgorithms), "Hidden-surface method",
         "raytrace: the whole light model; zbuffer, warnock: local light, with shadows by rays; roberts: a line "
         "drawing.",
         "\"raytrace\""},
        {"shading", words_rule(kShadings), "Shading rule",
         "flat: lit once a face, at its middle; gouraud: lit at the corners; phong: lit at every point.", "\"phong\""},
        {"shadows", boolean_rule(), "Whether any light casts shadows", "", "true"},
        {"max_depth", whole_rule(0, limits.max_depth, true), "Secondary rays in a row", "0: local light only.", "8"},
        {"weight_cutoff", number_rule(kUnitInterval), "Least weight of a path that is followed", "", "0.002"},
        {"ray_budget", whole_rule(1, limits.ray_budget, true), "Rays a pixel sample", "", "4096"},
        {"terminator", words_rule(kTerminators), "Where light ends on meshes with smooth normals",
         "smooth: on the curved surface that the facets stand for; exact: facet by facet.", "\"smooth\""},
        {"filter", words_rule(kFilters), "Pixel filter",
         "box: the pixel's square; tent: a pixel to each side of its middle; gaussian: of half a pixel's deviation.",
         "\"box\""},
        {"tessellate", boolean_rule(), "Whether spheres become triangles",
         "Always so by every method but ray tracing and every shading but phong.", "false"},
        {"chord_error_px", number_rule({.min = 0.01, .max = 100.0}), "How far those triangles may lie off",
         "Pixels, as seen from the eye.", "0.25"},
        {"hidden_lines", boolean_rule(), "Whether roberts draws hidden lines too", "Dashed.", "false"},
        {"seed", whole_rule(0, 4294967295.0), "Seed of the sampling pattern", "", "0"},
        {"samples", whole_rule(1, limits.samples, true), "Stop rule: samples a pixel",
         "In the mean over pixels. 16 where no rule is given; the server's limit beside `rmse` or `time_ms` alone."},
        {"time_ms", number_rule({.min = 0.0, .max = limits.time_ms, .above_min = true, .is_limit = true}),
         "Stop rule: time", "Milliseconds."},
        {"passes", numbers_rule(pass, {.min = 1, .max = limits.samples, .is_limit = true}),
         "Stop rule: an exact replay", "Samples a pixel of every pass, as a report lists them; the first is whole."},
        {"rmse", number_rule(kPositive), "Stop rule: error",
         "Root mean square of displayed - true over pixels and channels, displayed from 0 to 1: the upper end of the "
         "estimate."},
        {"adaptive", boolean_rule(), "Whether samples go where the error is",
         "Else every pixel takes as many. True where a rule on `rmse` or `time_ms` is given."}}});
}

}  // namespace tilelight
