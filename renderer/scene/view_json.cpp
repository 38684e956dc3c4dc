// SPDX-License-Identifier: Apache-2.0
// A view written as a document, so that overrides can be merged into it and then be checked like any other.
#include <nlohmann/json.hpp>

#include "renderer/base/standard_floats.h"
#include "renderer/scene/build.h"
#include "renderer/scene/check.h"
#include "renderer/scene/parse.h"
#include "renderer/scene/read_json.h"
#include "renderer/scene/words.h"

namespace tilelight {
namespace {

using nlohmann::json;

json to_json(const Vec3& v) { return {v.x, v.y, v.z}; }

// `type` is that of the camera to come: a lens of the other kind is left out, or it would be an unknown key.
json to_json(const Camera& camera, std::string_view type) {
  json out = {{"type", type},
              {"position", to_json(camera.position)},
              {"target", to_json(camera.target)},
              {"up", to_json(camera.up)}};
  if (type == get_word(kProjections, camera.projection)) {
    const bool is_perspective = camera.projection == Projection::perspective;
    out[is_perspective ? "fov_y_deg" : "height"] = is_perspective ? camera.fov_y_deg : camera.height;
  }
  return out;
}

json to_json(const ImageSpec& image) {
  return {{"width", image.width}, {"height", image.height}, {"exposure", image.exposure}};
}

json to_json(const RenderSpec& render) {
  json out = {{"algorithm", get_word(kAlgorithms, render.algorithm)},
              {"shading", get_word(kShadings, render.shading)},
              {"shadows", render.shadows},
              {"terminator", get_word(kTerminators, render.terminator)},
              {"filter", get_word(kFilters, render.filter)},
              {"tessellate", render.tessellate},
              {"chord_error_px", render.chord_error_px},
              {"hidden_lines", render.hidden_lines},
              {"max_depth", render.max_depth},
              {"weight_cutoff", render.weight_cutoff},
              {"ray_budget", render.ray_budget},
              {"seed", render.seed}};
  if (render.samples && !render.samples_implied) out["samples"] = *render.samples;
  if (render.rmse) out["rmse"] = *render.rmse;
  if (render.time_ms) out["time_ms"] = *render.time_ms;
  if (render.adaptive != (render.rmse || render.time_ms)) out["adaptive"] = render.adaptive;
  if (!render.passes.empty()) out["passes"] = render.passes;
  return out;
}

// The type that the camera has after the merge, as far as the overrides can be understood.
std::string merged_camera_type(const Camera& base, const json& overrides) {
  static const json::json_pointer kType("/camera/type");
  if (overrides.is_object() && overrides.contains(kType) && overrides.at(kType).is_string()) {
    return overrides.at(kType).get<std::string>();
  }
  return std::string(get_word(kProjections, base.projection));
}

std::string merge_over(const View& base, std::string_view text) {
  const json overrides = json::parse(text);
  json merged = {{"image", to_json(base.image)}, {"render", to_json(base.render)}};
  if (base.camera) merged["camera"] = to_json(*base.camera, merged_camera_type(*base.camera, overrides));
  merged.merge_patch(overrides);
  return merged.dump();
}

}  // namespace

::tl::expected<View, SceneErrors> parse_view(std::string_view text, const View& base, const Limits& limits) {
  const StandardFloats floats;
  auto overrides = read_document(text, limits);  // bounds the depth, so that json::parse is safe
  if (!overrides) return ::tl::unexpected(std::move(overrides.error()));
  auto document = read_document(merge_over(base, text), limits);
  if (!document) return ::tl::unexpected(std::move(document.error()));
  Problems problems;
  report_duplicates(*overrides, problems);
  check_document(document->root(), view_grammar(limits), problems);
  const View view = build_view(document->root(), limits, problems);
  if (problems.any()) return ::tl::unexpected(problems.take_errors(text));
  return view;
}

}  // namespace tilelight
