// SPDX-License-Identifier: Apache-2.0
#include "renderer/check/kit/pictures.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <stdexcept>

#include "renderer/film/tone.h"
#include "renderer/trace/primary_ids.h"

namespace tilelight::check {
ParsedScene scene_of(std::string_view json) {
  auto parsed = parse_scene(json, Limits{});
  if (!parsed) {
    const SceneError& error = parsed.error().errors.front();
    throw std::logic_error("a scene of the catalogue is wrong: " + error.pointer + ": " + error.detail);
  }
  RenderSpec& render = parsed->view.render;
  if (render.samples_implied && !render.rmse && !render.time_ms && render.passes.empty()) render.samples = 1;
  return *std::move(parsed);
}

std::string text(double value) {
  std::array<char, 32> digits{};
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

std::string text(const Vec3& v) { return "[" + text(v.x) + "," + text(v.y) + "," + text(v.z) + "]"; }

std::string image_text(int width, int height) {
  return R"("image":{"width":)" + std::to_string(width) + R"(,"height":)" + std::to_string(height) + "}";
}

Picture picture_of(const ParsedScene& parsed, TilePool& pool, int tile_px) {
  const auto compiled = compile_scene(parsed.scene, pool);
  const ViewPlan plan = plan_view(*compiled, parsed.view);
  RenderOptions options;
  options.tile_px = tile_px;
  const auto render = Render::start(pool, Priority::normal, compiled, plan, options);
  while (!render->wait_ms(1e9)) continue;
  if (render->progress().state != RenderState::done) throw std::logic_error("a render of the catalogue failed");

  const auto image = render->image();
  Picture picture{image->width,    image->height,           to_srgb8(*image, parsed.view.image.exposure),
                  image->rgb,      *render->error_bounds(), primary_ids(*compiled, plan),
                  parsed.warnings, render->report()};
  picture.warnings.insert(picture.warnings.end(), plan.plan.warnings.begin(), plan.plan.warnings.end());
  return picture;
}

double differing_ids(const std::vector<uint64_t>& a, const std::vector<uint64_t>& b) {
  size_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) count += a[i] != b[i];
  return percent(static_cast<int64_t>(count), static_cast<int64_t>(a.size()));
}

double differing_pixels(const std::vector<uint8_t>& rgb_a, const std::vector<uint8_t>& rgb_b) {
  size_t count = 0;
  for (size_t i = 0; i < rgb_a.size(); i += 3) count += !std::equal(&rgb_a[i], &rgb_a[i] + 3, &rgb_b[i]);
  return percent(static_cast<int64_t>(count), static_cast<int64_t>(rgb_a.size() / 3));
}

double differing_bits(const std::vector<float>& a, const std::vector<float>& b) {
  if (a.size() != b.size() || a.empty()) return 100.0;
  size_t count = 0;
  for (size_t i = 0; i < a.size(); i += 3) count += std::memcmp(&a[i], &b[i], 3 * sizeof(float)) != 0;
  return 300.0 * static_cast<double>(count) / static_cast<double>(a.size());
}

double coverage(const std::vector<uint64_t>& ids, uint32_t body) {
  const auto count = std::count_if(ids.begin(), ids.end(), [&](uint64_t id) { return id >> 32 == body; });
  return static_cast<double>(count) / static_cast<double>(ids.size());
}

std::vector<uint64_t> reference_ids(const ParsedScene& parsed, TilePool& pool) {
  View view = parsed.view;
  view.render.max_depth = 0;
  view.render.shadows = false;
  const ReferenceScene scene(parsed.scene);
  const auto compiled = compile_scene(parsed.scene, pool);  // for its framing alone
  std::vector<uint64_t> ids;
  for (const ReferencePixel& pixel : reference_image(scene, view, plan_view(*compiled, view).camera, pool))
    ids.push_back(pixel.primary_id);
  return ids;
}

}  // namespace tilelight::check
