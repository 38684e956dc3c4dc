// SPDX-License-Identifier: Apache-2.0
// What most rows do: a scene from JSON, its picture, and how far two pictures are apart.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/check/check.h"
#include "renderer/measure/judge.h"
#include "renderer/render/render.h"
#include "renderer/scene/parse.h"

namespace tilelight::check {

// Of a document that is known to be good; throws std::logic_error with its first error.
ParsedScene scene_of(std::string_view json);

// "image": {...} of a document; and the catalogue's usual edge, pixels.
std::string image_text(int width, int height);
// The shortest text that reads back as the same number; "[x,y,z]".
std::string text(double value);
std::string text(const Vec3& v);
inline int side_of(const Context& context) { return context.is_quick ? 128 : 512; }

// One sample a pixel unless the document says otherwise.
struct Picture {
  int width = 0, height = 0;           // pixels
  std::vector<uint8_t> rgb;            // sRGB, 3 bytes a pixel
  std::vector<float> linear;           // 3 a pixel
  std::vector<float> error_bounds;     // by pixel
  std::vector<uint64_t> ids;           // first surfaces, see surface_id
  std::vector<SceneWarning> warnings;  // of parsing and of compiling
  RenderReport report;

  int64_t nonfinite() const { return report.points.empty() ? 0 : report.points.back().nonfinite; }
};
// tile_px 0: chosen by the renderer.
Picture picture_of(const ParsedScene& parsed, TilePool& pool, int tile_px = 0);

// In percent of all pixels. REQUIRES: pictures of one size.
double differing_ids(const std::vector<uint64_t>& a, const std::vector<uint64_t>& b);
// Any bit of any channel, linear RGB.
double differing_bits(const std::vector<float>& a, const std::vector<float>& b);
double differing_pixels(const std::vector<uint8_t>& rgb_a, const std::vector<uint8_t>& rgb_b);

// The pixels of `ids` that show the body, as a part of all.
double coverage(const std::vector<uint64_t>& ids, uint32_t body);

// The ids that the reference in double sees.
std::vector<uint64_t> reference_ids(const ParsedScene& parsed, TilePool& pool);

}  // namespace tilelight::check
