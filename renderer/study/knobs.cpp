// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <set>
#include <variant>

#include "renderer/study/studio.h"

namespace tilelight::study {
namespace {

constexpr int kSamples = 4;  // a pixel; the same ones for every value, so that their noise cancels

double mean_linear(const Image& image) {
  double sum = 0.0;
  for (const float v : image.rgb) sum += v;
  return sum / static_cast<double>(image.rgb.size());
}

struct Setting {
  double value;
  std::shared_ptr<const CompiledScene> scene;
  View view;
};

// REQUIRES: the last setting is the exact one.
void compare(const Studio& studio, const std::string& knob, double of_scene, const std::vector<Setting>& settings,
             std::vector<KnobRow>& rows) {
  struct Result {
    Drawing drawing;
    double time_ms;
  };
  std::vector<Result> results;
  for (const Setting& setting : settings) {
    std::vector<double> times;
    Drawing drawing;
    for (int round = 0; round < studio.options().rounds; ++round) {
      drawing = studio.draw(setting.scene, setting.view);
      times.push_back(drawing.time_ms);
    }
    results.push_back({drawing, median(times)});
  }
  const Drawing& exact = results.back().drawing;
  const double exposure = settings.back().view.image.exposure;
  const DisplayedImage truth = displayed_image(*exact.image, exposure);
  for (size_t i = 0; i < results.size(); ++i) {
    const auto& [drawing, time_ms] = results[i];
    rows.push_back({.knob = knob,
                    .value = settings[i].value,
                    .is_of_scene = settings[i].value == of_scene,
                    .is_exact = i + 1 == results.size(),
                    .time_ms = time_ms,
                    .rmse = rms_difference(displayed_image(*drawing.image, exposure), truth),
                    .truncation = mean_linear(*exact.image) - mean_linear(*drawing.image),
                    .truncation_bound = drawing.truncation_bound});
  }
}

bool follows_rays(const CompiledScene& scene, const View& view) {
  const FeatureSet& features = plan_view(scene, view).features;
  return features.has(Feature::reflection) || features.has(Feature::transmission);
}

// By chess shape; 0 for other objects.
int detail_of(const Object& object) {
  if (const auto* piece = std::get_if<ChessPieceShape>(&object.shape)) return piece->detail;
  if (const auto* position = std::get_if<ChessPositionShape>(&object.shape)) return position->detail;
  return 0;
}

Scene with_detail(Scene scene, int detail) {
  for (Object& object : scene.objects) {
    if (auto* piece = std::get_if<ChessPieceShape>(&object.shape)) piece->detail = detail;
    if (auto* position = std::get_if<ChessPositionShape>(&object.shape)) position->detail = detail;
  }
  return scene;
}

}  // namespace

std::vector<KnobRow> turn_knobs(const Studio& studio, const Scene& scene, const View& of_scene) {
  std::vector<KnobRow> rows;
  const View view = with_samples(of_scene, kSamples, false);
  const auto compiled = compile_scene(scene, studio.pool());
  if (follows_rays(*compiled, view)) {
    const int depth = view.render.max_depth;
    std::vector<Setting> settings;
    for (const int value : std::set<int>{0, 1, 2, 4, 8, depth, std::max(32, 2 * depth)}) {
      settings.push_back({static_cast<double>(value), compiled, view});
      settings.back().view.render.max_depth = value;
    }
    compare(studio, "max_depth", depth, settings, rows);
    settings.clear();
    const double cutoff = view.render.weight_cutoff;
    for (const double value : std::set<double, std::greater<>>{0.3, 0.1, 0.03, 0.01, 0.002, cutoff, 0.0}) {
      settings.push_back({value, compiled, view});
      settings.back().view.render.weight_cutoff = value;
    }
    compare(studio, "weight_cutoff", cutoff, settings, rows);
  }
  std::set<int> details;
  for (const Object& object : scene.objects)
    if (const int detail = detail_of(object)) details.insert(detail);
  if (!details.empty()) {
    // Where chessmen differ in detail, no one value is the scene's.
    const double of_scene_detail = details.size() == 1 ? *details.begin() : 0.0;
    std::vector<Setting> settings;
    std::set<int> values{8, 16, 32, 64, std::max(256, *details.rbegin())};
    values.merge(std::set<int>(details));
    for (const int value : values)
      settings.push_back({static_cast<double>(value), compile_scene(with_detail(scene, value), studio.pool()), view});
    compare(studio, "detail", of_scene_detail, settings, rows);
  }
  return rows;
}

}  // namespace tilelight::study
